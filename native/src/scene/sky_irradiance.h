// How much light an environment brings to a plane, whatever stands before it.
#pragma once

#include <array>

#include "scene/environment.h"

namespace velour {

/// Irradiance (luminance) by the direction of the plane's normal, as nine spherical harmonics [RH01], from draws of the
/// environment: within a few per cent of it, more behind a sun, and never below a twentieth of its mean.
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
