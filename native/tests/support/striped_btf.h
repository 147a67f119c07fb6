// Uncompressed BTFs made of a formula.
#pragma once

#include "btf/eval/measured_btf_material.h"
#include "support/memory_btf.h"

namespace velour::test {

/// Rings of views and lights on one side of the plane, or on both.
inline PairLayout ringed_layout(bool two_sided = false) {
  std::vector<PolarAngles> views = ring_directions(30, 5), lights = ring_directions(50, 6);
  views.push_back({0, 0});
  lights.push_back({0, 0});
  for (const PolarAngles& d : ring_directions(75, 8)) {
    views.push_back(d);
    lights.push_back(d);
  }
  if (two_sided) {
    for (const PolarAngles& d : below(views)) views.push_back(d);
    for (const PolarAngles& d : below(lights)) lights.push_back(d);
  }
  return {views, lights};
}

/// Bright and dark stripes along y that lean with the light, with a highlight about the mirror direction; other colors
/// from below. Never 0.
inline Rgb striped(const DirectionPair& d, uint32_t x, uint32_t y) {
  const auto column = static_cast<float>(x), row = static_cast<float>(y);
  const float stripe = 0.3f + 0.25f * std::sin(1.1f * column + 0.2f * row + 2 * d.wl.x * d.wv.z);
  const float mirrored = std::max(0.0f, glm::dot(d.wl, Vec3(-d.wv.x, -d.wv.y, d.wv.z)));
  return stripe * Rgb(0.3f, 0.2f, d.wv.z > 0 ? 0.1f : 0.4f) + 0.8f * std::pow(mirrored, 10.0f) * stripe;
}

inline MemoryBtf striped_btf(TexelGrid grid, bool two_sided = false) {
  return {ringed_layout(two_sided), grid, striped};
}

}  // namespace velour::test
