// Skies of few lobes.
#pragma once

#include "light/environment_mixture.h"

namespace velour::test {

struct EnvironmentLobe {
  Vec3 center;  // of any length
  float bandwidth;
  Rgb coefficient;
};

inline EnvironmentMixture sky_of(const std::vector<EnvironmentLobe>& lobes) {
  EnvironmentMixture sky;
  for (const EnvironmentLobe& lobe : lobes) {
    sky.center.push_back(glm::normalize(lobe.center));
    sky.bandwidth.push_back(lobe.bandwidth);
    sky.coefficient.push_back(lobe.coefficient);
  }
  return sky;
}

}  // namespace velour::test
