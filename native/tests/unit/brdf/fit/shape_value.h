// The value of a lobe, in double.
#pragma once

#include <cmath>

#include "brdf/fit/slice_columns.h"

namespace velour::test {

/// The formula of LobeShape.
inline double shape_value(Kernel kernel, const LobeShape& s, const Vec3d& w) {
  const double kd = s.sharpness * one_minus_dot(w, s.center);
  return kernel == Kernel::gaussian ? std::exp(-kd) : std::pow(1 + 2.0 / 3.0 * kd, -1.5);
}

}  // namespace velour::test
