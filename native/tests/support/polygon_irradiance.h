// Light of polygons in closed form.
#pragma once

#include <array>
#include <cmath>

#include "math/sphere/vec.h"

namespace velour::test {

/// Lambert's formula: irradiance at the origin of plane z = 0 from a polygon of radiance 1 above it.
inline double polygon_irradiance(const std::array<Vec3d, 4>& corners) {
  double sum = 0;
  for (size_t i = 0; i < 4; ++i) {
    const Vec3d a = glm::normalize(corners[i]), b = glm::normalize(corners[(i + 1) % 4]);
    sum += std::acos(glm::dot(a, b)) * glm::normalize(glm::cross(a, b)).z;
  }
  return std::abs(sum) / 2;
}

}  // namespace velour::test
