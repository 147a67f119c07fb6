// Unoccluded irradiance of a plane in an environment.
#pragma once

#include <array>

#include "scene/environment.h"

namespace velour {

/// Irradiance (luminance) as a function of the plane's normal, as nine spherical harmonics [RH01], from samples of the
/// environment. Accurate to a few per cent, worse on planes that face away from a sun; at least a twentieth of the
/// mean.
class SkyIrradiance {
 public:
  SkyIrradiance() = default;  // black
  explicit SkyIrradiance(const Environment& sky);
  float on(const Vec3& normal) const;

 private:
  std::array<float, 9> weight_{};
  float least_ = 0;
};

}  // namespace velour
