// Shells whose contents have closed forms.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "math/sphere/vec.h"
#include "votf/eval/occlusion_volume.h"

namespace velour::test {

/// A volume of heights `bottom` to `top` with `distance` (widths of the tile) at its points; aspect 1.
inline std::shared_ptr<VotfVolume> shell_of(uint32_t texels, float bottom, float top,
                                            const std::function<float(const Vec3&)>& distance) {
  auto volume = std::make_shared<VotfVolume>();
  volume->width = volume->height = texels;
  volume->bottom = bottom;
  volume->top = top;
  volume->depth = static_cast<uint32_t>(std::ceil((top - bottom) * static_cast<float>(texels))) + 1;
  volume->reach = 8 * volume->pitch();
  for (uint32_t z = 0; z < volume->depth; ++z) {
    for (uint32_t y = 0; y < texels; ++y) {
      for (uint32_t x = 0; x < texels; ++x) {
        const Vec3 p((static_cast<float>(x) + 0.5f) * volume->pitch(), (static_cast<float>(y) + 0.5f) * volume->pitch(),
                     bottom + static_cast<float>(z) * volume->step());
        volume->distance.push_back(distance_byte(distance(p) / volume->reach));
      }
    }
  }
  return volume;
}

/// Wires along y, one a tile, of this radius about height 0 and x = 1/2.
inline std::shared_ptr<VotfVolume> wires(uint32_t texels, float radius) {
  return shell_of(texels, -radius - 2.0f / static_cast<float>(texels), radius + 2.0f / static_cast<float>(texels),
                  [radius](const Vec3& p) { return std::hypot(p.x - 0.5f, p.z) - radius; });
}

}  // namespace velour::test
