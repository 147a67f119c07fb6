// Mip level and positions of the texture look-ups for a ray footprint.
#pragma once

#include <algorithm>
#include <cmath>
#include "image/bilinear_texels.h"
#include "material/surface_site.h"
#include "math/sphere/vec.h"

namespace velour {

/// Trilinear look-ups [Wil83] at the level of the footprint's width, several along its length [MPFJ99].
struct FootprintTaps {
  int count = 1;
  float level = 0;        // log2 of a tap's width in texels
  bool magnified = true;  // the footprint is no longer than a texel: one look-up on the finest level
  Vec2 step{0.0f};        // between taps, in texture coordinates

  Vec2 place(const Vec2& uv, int tap) const {
    return uv + (static_cast<float>(tap) - 0.5f * static_cast<float>(count - 1)) * step;
  }
  static constexpr int kMost = 8;
};

/// `footprint`: sides (columns) of a parallelogram in texture coordinates, of any size; `size`: texels along both axes.
/// A footprint whose aspect ratio exceeds FootprintTaps::kMost is widened to that ratio.
FootprintTaps footprint_taps(const Mat2& footprint, const Vec2& size);

// Texels of a repeating tile's pyramid that a site of the surface covers.

/// Calls `visit(level, texel, weight)` for the four texels around `uv` on one level; weights sum to `weight`.
template <typename Levels, typename Visit>
void visit_bilinear(const Vec2& uv, const Levels& levels, size_t level, float weight, const Visit& visit) {
  const Vec2 place = std::isfinite(uv.x + uv.y) ? uv : Vec2(0.0f);
  const BilinearTexels texels = bilinear_texels(place, levels[level].width, levels[level].height);
  for (size_t corner = 0; corner < 4; ++corner) visit(level, texels.index[corner], weight * texels.weight[corner]);
}

/// visit_bilinear() on the two levels around `level`.
template <typename Levels, typename Visit>
void visit_trilinear(const Vec2& uv, const Levels& levels, float level, float weight, const Visit& visit) {
  const float place = std::clamp(level, 0.0f, static_cast<float>(levels.size() - 1));
  const auto fine = static_cast<size_t>(place);
  const float part = place - static_cast<float>(fine);
  visit_bilinear(uv, levels, fine, weight * (1 - part), visit);
  if (part > 0) visit_bilinear(uv, levels, fine + 1, weight * part, visit);
}

/// Visits all texels under a site's footprint; weights sum to 1. `levels`: a sequence of objects with a width and a
/// height, finest first. Texture coordinates are in tiles.
template <typename Levels, typename Visit>
void visit_texels(const SurfaceSite& site, const Levels& levels, const Visit& visit) {
  const FootprintTaps taps = footprint_taps(site.footprint, Vec2(levels[0].width, levels[0].height));
  for (int i = 0; i < taps.count; ++i) {
    visit_trilinear(taps.place(site.uv, i), levels, taps.level, 1.0f / static_cast<float>(taps.count), visit);
  }
}

}  // namespace velour
