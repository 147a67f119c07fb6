// Observations with a formula behind them: views and light as a test wants them.
#pragma once

#include <cmath>
#include <functional>

#include "math/sphere/random.h"
#include "usage/observation.h"

namespace velour::test {

using Light = std::function<float(const Vec3& wl)>;

/// A dim sky with a broad bright patch about `axis`.
inline Light soft_light(const Vec3& axis) {
  return [axis](const Vec3& wl) { return 0.3f + 2 * std::exp(3 * (glm::dot(wl, axis) - 1)); };
}

/// `hits` seen from `first` to `last` degrees, each under a light of its own that `light_at` makes of a direction,
/// sampled by the cosine: two halves of `terms`.
inline SceneObservation observed(int hits, int terms, float first, float last,
                                 const std::function<Light(const Vec3&)>& light_at, uint64_t seed = 1) {
  RandomStream random(seed, 0, 0);
  SceneObservation o;
  for (int h = 0; h < hits; ++h) {
    const float theta =
        radians_from(first + (last - first) * (static_cast<float>(h) + 0.5f) / static_cast<float>(hits));
    ObservedHit hit{static_cast<uint64_t>(h), direction(theta, 2 * kPi * random.next()), 0, 0, 0};
    const Light light = light_at(direction(0.8f * random.next(), 2 * kPi * random.next()));
    hit.first = static_cast<uint32_t>(o.wl.size());
    for (int i = 0; i < 2 * terms; ++i) {
      if (i == terms) hit.middle = static_cast<uint32_t>(o.wl.size());
      // Strata along the radius, a golden-ratio lattice about it, turned at random.
      const float u = (static_cast<float>(i % terms) + random.next()) / static_cast<float>(terms);
      const float phi = 2 * kPi * (0.618034f * static_cast<float>(i) + random.next() / 8);
      const Vec3 wl(std::sqrt(u) * std::cos(phi), std::sqrt(u) * std::sin(phi), std::sqrt(std::max(1 - u, 1e-6f)));
      o.wl.push_back(wl);
      o.light.emplace_back(light(wl) * kPi / static_cast<float>(terms));
    }
    hit.last = static_cast<uint32_t>(o.wl.size());
    o.hits.push_back(hit);
    o.domain.view[static_cast<size_t>(theta_of(hit.wv) * 180 / kPiD)] += 1;
  }
  o.domain.camera_rays = static_cast<uint64_t>(hits);
  o.domain.frames = 1;
  o.domain.light_density = 1;
  return o;
}

inline SceneObservation softly_lit(int hits, int terms, float first, float last, uint64_t seed = 1) {
  return observed(hits, terms, first, last, soft_light, seed);
}

}  // namespace velour::test
