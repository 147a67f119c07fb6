// Skies of few lobes.
#pragma once

#include "light/environment_mixture.h"

namespace velour::test {

struct SkyLobe {
  Vec3 center;  // of any length
  float bandwidth;
  Rgb coefficient;
};

inline SkyMixture sky_of(const std::vector<SkyLobe>& lobes) {
  SkyMixture sky;
  for (const SkyLobe& lobe : lobes) {
    sky.center.push_back(glm::normalize(lobe.center));
    sky.bandwidth.push_back(lobe.bandwidth);
    sky.coefficient.push_back(lobe.coefficient);
  }
  return sky;
}

}  // namespace velour::test
