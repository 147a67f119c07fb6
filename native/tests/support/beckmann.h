// The closed form that the virtual goniometer is held against.
#pragma once

#include <cmath>

#include "math/sphere/vec.h"

namespace velour::test {

/// Smith's Lambda of a Beckmann surface (Heitz 2014, JCGT 3(2)).
inline double smith_lambda(double alpha, double cos_theta) {
  const double tan_theta = std::sqrt(1 - cos_theta * cos_theta) / cos_theta;
  if (tan_theta < 1e-9) return 0;
  const double a = 1 / (alpha * tan_theta);
  return 0.5 * (std::erf(a) - 1) + std::exp(-a * a) / (2 * a * std::sqrt(kPiD));
}

/// D G2 / (4 cos cos): single reflection of a lossless Beckmann surface with height-correlated Smith masking.
inline double beckmann(double alpha, const DirectionPair& pair) {
  const Vec3 h = glm::normalize(pair.wl + pair.wv);
  const double cos_sq = static_cast<double>(h.z * h.z), tan_sq = (1 - cos_sq) / cos_sq;
  const double d = std::exp(-tan_sq / (alpha * alpha)) / (kPiD * alpha * alpha * cos_sq * cos_sq);
  const auto l = static_cast<double>(pair.wl.z), v = static_cast<double>(pair.wv.z);
  return d / (1 + smith_lambda(alpha, l) + smith_lambda(alpha, v)) / (4 * l * v);
}

}  // namespace velour::test
