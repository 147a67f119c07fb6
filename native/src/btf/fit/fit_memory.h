// Memory use of fits, and what fits into a memory limit.
#pragma once

#include <cstdint>
#include <string>

#include "btf/measure/btf_measurement.h"

namespace velour {

/// Sizes that determine the memory of a fit.
struct FitExtent {
  uint64_t texels = 0, pyramid_texels = 0, pairs = 0;
  uint64_t lights = 0;  // per view
  uint64_t sides = 1;
  uint64_t points = 0, point_pairs = 0;  // for refining lobes: points per side, pairs per point
  uint64_t coefficients = 0;             // per texel, or number of components
  uint64_t threads = 1;
  bool by_view = false;  // each component serves one view
};

/// Estimated requirements of a fit, from its sizes alone.
struct FitSize {
  uint64_t memory = 0;        // peak memory in bytes without a limit
  uint64_t least_memory = 0;  // smallest feasible limit in bytes
  uint64_t bytes = 0;         // upper bound on the bytes of all coefficients
};

/// Number of points for choosing the order of SRBFs, between the minimum and the default, that keeps the fit within
/// `memory` bytes. Throws Error(unsupported) with the smallest feasible limit.
uint32_t search_points_within(uint64_t memory, const FitExtent& extent);
/// The smallest limit that allows all points, and so gives the same model as no limit.
uint64_t memory_for_all_points(const FitExtent& extent);
/// The smallest feasible limit.
uint64_t memory_for_least_points(const FitExtent& extent);

/// Rounded up to whole megabytes: "17 MB".
std::string megabytes(uint64_t bytes);

/// Memory of a truncated SVD of `extent.coefficients` components.
uint64_t memory_for_components(const FitExtent& extent);
/// Throws Error(unsupported), with the required memory, if such an SVD holds more than `memory` bytes.
void require_components(uint64_t memory, const FitExtent& extent);

/// Maximum number of components, up to `extent.coefficients`, of a truncated SVD within `memory` bytes. Throws
/// Error(unsupported) with the smallest feasible limit.
uint64_t components_within(uint64_t memory, FitExtent extent);

/// Limits on the data held by a fit of clustered tensors.
struct TensorAllowance {
  size_t point_floats = 16 << 20;  // size of the points from which direction bases are computed
  size_t slices = 6144;            // texels that are clustered
  uint32_t functions = 640;        // total over all clusters; their products are held for each view
};

/// Memory of a fit with this allowance. `entries`: per slice.
uint64_t memory_for_tensors(const FitExtent& extent, uint64_t entries, const TensorAllowance& allowance);
/// The minimum for any fit.
TensorAllowance least_tensor_allowance();
/// The largest allowance that keeps the fit within `memory` bytes (0: no limit). Throws Error(unsupported) with the
/// smallest feasible limit.
TensorAllowance tensor_allowance(uint64_t memory, const FitExtent& extent, uint64_t entries);

}  // namespace velour
