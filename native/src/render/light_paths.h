// Cycles' settings against fireflies, with the same meaning. All of them bias the image, and are off by default.
#pragma once

#include <cmath>
#include <limits>

#include "material/lobe_filter.h"
#include "sphere/vec.h"

namespace velour {

struct LightPathOptions {
  /// Maximum mean of the channels of one sample's light that comes straight from emitters to the first surface or the
  /// camera, and of all its other light. 0: no limit.
  float clamp_direct = 0, clamp_indirect = 0;
  float filter_glossy = 0;  // roughens lobes after directions of a density below it; 0: off
  bool reflective_caustics = true;

  /// Maximum sum of the channels of a contribution at a surface after `bounces` bounces; infinite: no limit.
  float limit(int bounces) const {
    const float mean = bounces > 0 ? clamp_indirect : clamp_direct;
    return mean > 0.0f ? 3.0f * mean : std::numeric_limits<float>::infinity();
  }
};

/// State that earlier bounces of a path pass on to later surfaces.
struct PathPast {
  float least_density = std::numeric_limits<float>::infinity();  // minimum over the sampled directions, 1/sr
  bool was_diffuse = false;                                      // whether the last bounce was diffuse
};

/// As in Cycles (kernel/integrator/surface_shader.h, kernel/svm/closure.h).
inline LobeFilter lobe_filter(const LightPathOptions& options, const PathPast& past) {
  LobeFilter filter;
  if (past.least_density < options.filter_glossy) {
    filter.min_alpha = 0.5f * std::sqrt(1.0f - past.least_density / options.filter_glossy);
  }
  filter.diffuse_only = !options.reflective_caustics && past.was_diffuse;
  return filter;
}

/// `light`, scaled down to the sum `limit` if it is brighter; its hue stays.
inline Rgb clamped(const Rgb& light, float limit) {
  const float sum = std::abs(light.r) + std::abs(light.g) + std::abs(light.b);
  return sum > limit ? light * (limit / sum) : light;
}

}  // namespace velour
