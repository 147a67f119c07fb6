// Lookup of a view ray in a mip pyramid of reliefs.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "sphere/vec.h"

namespace velour {

/// The two mip levels of a lookup and the positions on them.
struct SeenLevels {
  size_t fine;         // the finer level; the other is the next
  float part;          // weight of the coarser level, in [0, 1)
  Vec2 texel, coarse;  // in texels from the center of the first one; `coarse` only if `part` is not 0
};

/// `levels`: finest first; each has texels(), the resolution along both axes, and seen_texel(place, wv)
/// (Relief::seen_texel). `uv`: in tiles, periodic. `level`: clamped to the available levels.
template <typename Levels>
SeenLevels seen_levels(const Levels& levels, const Vec2& uv, float level, const Vec3& wv) {
  const float place = std::clamp(level, 0.0f, static_cast<float>(levels.size() - 1));
  const auto fine = static_cast<size_t>(place);
  const Vec2 inside = std::isfinite(uv.x + uv.y) ? uv - glm::floor(uv) : Vec2(0.0f);
  SeenLevels seen{fine, place - static_cast<float>(fine), levels[fine].seen_texel(inside, wv), Vec2(0.0f)};
  if (seen.part == 0) return seen;
  // The finer relief is intersected once, for both levels.
  seen.coarse = (seen.texel + 0.5f) * (levels[fine + 1].texels() / levels[fine].texels()) - 0.5f;
  return seen;
}

}  // namespace velour
