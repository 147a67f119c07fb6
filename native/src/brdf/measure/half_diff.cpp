#include "brdf/measure/half_diff.h"

namespace velour {

DirectionPair pair_of_half_diff(double theta_h, double phi_h, double theta_d, double phi_d) {
  const double sin_h = std::sin(theta_h), cos_h = std::cos(theta_h);
  const double sin_p = std::sin(phi_h), cos_p = std::cos(phi_h);
  const Vec3d half{sin_h * cos_p, sin_h * sin_p, cos_h};
  const Vec3d along{cos_h * cos_p, cos_h * sin_p, -sin_h}, across{-sin_p, cos_p, 0.0};
  const Vec3d side = std::sin(theta_d) * (std::cos(phi_d) * along + std::sin(phi_d) * across);
  const Vec3d up = std::cos(theta_d) * half;
  return {Vec3(up + side), Vec3(up - side)};
}

}  // namespace velour
