// Texels of a repeating tile's pyramid that a site of the surface covers.
#pragma once

#include <algorithm>
#include <cmath>

#include "btf/bilinear_texels.h"
#include "material/footprint_taps.h"
#include "material/surface_site.h"

namespace velour {

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
