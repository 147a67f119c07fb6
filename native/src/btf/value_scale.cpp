#include "btf/value_scale.h"

#include <cmath>

#include "sphere/directions.h"

namespace velour {

float ValueScale::of(const PolarAngles& light) const {
  // No light is close enough to the plane for this to be 0 (btf/pair_layout.h).
  const double cosine_of_light = cosine ? std::abs(static_cast<double>(unit_direction(light).z)) : 1.0;
  return static_cast<float>(factor / cosine_of_light);
}

std::string ValueScale::text() const {
  if (factor == 1) return cosine ? "f = number / cos(theta_l)" : "f = number";
  return cosine ? "f = number / (pi cos(theta_l))" : "f = number / pi";
}

ValueScale scale_of(BtfValues values) {
  switch (values) {
    case BtfValues::reflectance:
      return {1 / kPiD, false};
    case BtfValues::radiance:
      return {1 / kPiD, true};
    default:
      return {1, false};
  }
}

}  // namespace velour
