// Cycles' settings against fireflies, with the meaning that they have there. Each biases the picture; all are off.
#pragma once

#include <cmath>
#include <limits>

#include "material/lobe_filter.h"
#include "sphere/vec.h"

namespace velour {

struct LightPathOptions {
  /// Largest mean of the channels of what one sample brings of light that comes straight from emitters to the first
  /// surface or the camera, and of all other light. 0: none.
  float clamp_direct = 0, clamp_indirect = 0;
  float filter_glossy = 0;  // roughens lobes behind directions of a density below it; 0: none
  bool reflective_caustics = true;

  /// The largest sum of the channels of a contribution at a surface that `bounces` lead to; infinite: any.
  float limit(int bounces) const {
    const float mean = bounces > 0 ? clamp_indirect : clamp_direct;
    return mean > 0.0f ? 3.0f * mean : std::numeric_limits<float>::infinity();
  }
};

/// State that earlier bounces of a path leave for the surfaces it meets later.
struct PathPast {
  float least_density = std::numeric_limits<float>::infinity();  // of the directions drawn so far, per solid angle
  bool was_diffuse = false;                                      // the last bounce
};

/// Cycles' (kernel/integrator/surface_shader.h, kernel/svm/closure.h).
inline LobeFilter lobe_filter(const LightPathOptions& options, const PathPast& past) {
  LobeFilter filter;
  if (past.least_density < options.filter_glossy) {
    filter.min_alpha = 0.5f * std::sqrt(1.0f - past.least_density / options.filter_glossy);
  }
  filter.diffuse_only = !options.reflective_caustics && past.was_diffuse;
  return filter;
}

/// `light`, darkened to the sum `limit` where it is brighter; its hue stays.
inline Rgb clamped(const Rgb& light, float limit) {
  const float sum = std::abs(light.r) + std::abs(light.g) + std::abs(light.b);
  return sum > limit ? light * (limit / sum) : light;
}

}  // namespace velour
