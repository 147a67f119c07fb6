// Where a view meets a pyramid of reliefs.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "sphere/vec.h"

namespace velour {

/// The two levels that a look-up lies between, and where on them.
struct SeenLevels {
  size_t fine;         // the finer one; the other is the next
  float part;          // of the coarser one, in [0, 1)
  Vec2 texel, coarse;  // in texels from the centre of the first one; `coarse` only where `part` is not 0
};

/// `levels`: the finest first, each with texels(), how many along both axes, and seen_texel(place, wv), where the view
/// meets it (Relief::seen_texel). `uv` in tiles, which repeat; `level` is taken as one that there is.
template <typename Levels>
SeenLevels seen_levels(const Levels& levels, const Vec2& uv, float level, const Vec3& wv) {
  const float place = std::clamp(level, 0.0f, static_cast<float>(levels.size() - 1));
  const auto fine = static_cast<size_t>(place);
  const Vec2 inside = std::isfinite(uv.x + uv.y) ? uv - glm::floor(uv) : Vec2(0.0f);
  SeenLevels seen{fine, place - static_cast<float>(fine), levels[fine].seen_texel(inside, wv), Vec2(0.0f)};
  if (seen.part == 0) return seen;
  // Once for both levels: where the finer relief is met.
  seen.coarse = (seen.texel + 0.5f) * (levels[fine + 1].texels() / levels[fine].texels()) - 0.5f;
  return seen;
}

}  // namespace velour
