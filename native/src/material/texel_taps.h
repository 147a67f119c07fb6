// Which texels of a repeating tile's pyramid a site of the surface is made of.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "material/footprint_taps.h"
#include "material/surface_site.h"

namespace velour {

/// `i` of a period `size`, for -1 <= i <= size.
inline uint32_t wrapped(int i, uint32_t size) {
  const int n = static_cast<int>(size);
  return static_cast<uint32_t>(i < 0 ? i + n : (i >= n ? i - n : i));
}

/// Calls `visit(level, texel, weight)` for the four texels about `uv` of one level, `weight` in all.
template <typename Levels, typename Visit>
void visit_bilinear(const Vec2& uv, const Levels& levels, size_t level, float weight, const Visit& visit) {
  const uint32_t width = levels[level].width, height = levels[level].height;
  const Vec2 inside = std::isfinite(uv.x + uv.y) ? uv - glm::floor(uv) : Vec2(0.0f);
  const Vec2 place = inside * Vec2(width, height) - 0.5f, low = glm::floor(place), part = place - low;
  for (int corner = 0; corner < 4; ++corner) {
    const int dx = corner & 1, dy = corner >> 1;
    const float share = weight * (dx ? part.x : 1 - part.x) * (dy ? part.y : 1 - part.y);
    const uint64_t texel =
        uint64_t{wrapped(static_cast<int>(low.y) + dy, height)} * width + wrapped(static_cast<int>(low.x) + dx, width);
    visit(level, texel, share);
  }
}

/// The same of the two levels about `level`.
template <typename Levels, typename Visit>
void visit_trilinear(const Vec2& uv, const Levels& levels, float level, float weight, const Visit& visit) {
  const float place = std::clamp(level, 0.0f, static_cast<float>(levels.size() - 1));
  const auto fine = static_cast<size_t>(place);
  const float part = place - static_cast<float>(fine);
  visit_bilinear(uv, levels, fine, weight * (1 - part), visit);
  if (part > 0) visit_bilinear(uv, levels, fine + 1, weight * part, visit);
}

/// The same of all that a site's footprint covers, 1 in all. `levels`: a sequence of what has a width and a height, the
/// finest first. Texture coordinates count tiles.
template <typename Levels, typename Visit>
void visit_texels(const SurfaceSite& site, const Levels& levels, const Visit& visit) {
  const FootprintTaps taps = footprint_taps(site.footprint, Vec2(levels[0].width, levels[0].height));
  for (int i = 0; i < taps.count; ++i) {
    visit_trilinear(taps.place(site.uv, i), levels, taps.level, 1.0f / static_cast<float>(taps.count), visit);
  }
}

}  // namespace velour
