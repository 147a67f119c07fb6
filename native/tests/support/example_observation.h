// Observations made by hand.
#pragma once

#include "math/sphere/random.h"
#include "usage/observation.h"

namespace velour::test {

/// `count` hits of two to five terms each, at all views, of weight 1.
inline SceneObservation example_observation(size_t count, uint64_t seed = 1) {
  RandomStream random(seed, 0, 0);
  const auto above = [&random] { return direction(1.5f * random.next(), 6.0f * random.next()); };
  SceneObservation o;
  for (size_t i = 0; i < count; ++i) {
    ObservedHit hit{(i + 1) << 40 | random.next_bits() >> 30, above(), 0, 0, 0, 2 * random.next()};
    hit.first = static_cast<uint32_t>(o.wl.size());
    hit.middle = hit.first + 1 + static_cast<uint32_t>(i % 3);
    hit.last = hit.middle + 1 + static_cast<uint32_t>(i % 2);
    while (o.wl.size() < hit.last) {
      o.wl.push_back(above());
      o.light.emplace_back(random.next(), random.next(), random.next());
    }
    o.domain.view[static_cast<size_t>(theta_of(hit.wv) * 180 / kPiD)] += 1;
    o.domain.light_density = std::max(o.domain.light_density, static_cast<double>(hit.light_density));
    o.hits.push_back(hit);
  }
  o.domain.camera_rays = 4 * count;
  o.domain.frames = 1;
  for (uint64_t& word : o.domain.hash) word = random.next_bits();
  return o;
}

}  // namespace velour::test
