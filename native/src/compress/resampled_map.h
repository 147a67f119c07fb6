// Maps over a tile, taken to a coarser grid.
#pragma once

#include <cstdint>
#include <Eigen/Core>
#include <vector>

#include "btf/half_floats.h"

namespace velour {

/// Takes values at `from` places along a period to values at `to` < `from` places, so that what bilinear interpolation
/// makes of them, averaged over `window` of the period (0..1), differs least in the mean square [UAE91 do the same for
/// splines]. Plain averages would be blurred twice: by the average and by the interpolation.
Eigen::MatrixXf resampling(uint32_t from, uint32_t to, double window);

/// A map, [row][column][value] with `values` a texel, at other sizes; `x` and `y` are resampling() of its columns and
/// of its rows.
std::vector<HalfBits> resampled(const std::vector<HalfBits>& map, size_t values, const Eigen::MatrixXf& x,
                                const Eigen::MatrixXf& y);

}  // namespace velour
