// Site on a surface at which a material is evaluated, and the texels under its footprint.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include "image/texels.h"
#include "math/sphere/vec.h"

namespace velour {

// Position and footprint on a surface at which a material is evaluated.

/// Texture coordinates and ray footprint: `uv`, and the sides of the parallelogram about it that the ray covers.
struct SitePlace {
  Vec2 uv{0.0f};
  Mat2 footprint{0.0f};
};

/// Input of materials that vary over the surface (Material::varies); uniform ones use `back` alone.
struct SurfaceSite {
  Vec2 uv{0.0f};  // u grows along the local frame's +x; +y is on the side to which v grows
  /// Ray footprint: sides (columns) of a parallelogram about `uv`, in texture coordinates. Zero: a point. At a grazing
  /// angle it is long, but finite.
  Mat2 footprint{0.0f};
  /// Places on further sets of texture coordinates, for materials that use several (place()).
  static constexpr size_t kMaxSets = 4;  // `uv` included
  std::array<SitePlace, kMaxSets - 1> others{};
  /// Interpolated corner colors of the mesh, for materials that use them. Not averaged over the footprint.
  static constexpr size_t kMaxColorSets = 4;
  std::array<Rgb, kMaxColorSets> colors{};
  /// Outputs of the material's program (SurfaceMaterial::program), if it has one. Numbers are in all components,
  /// normals are unit and in the local frame.
  static constexpr size_t kMaxComputed = 16;
  std::array<Rgb, kMaxComputed> computed{};
  /// For HoledBtfMaterial: offset from `uv` to its mirror image at a silhouette close enough for texels to reach over
  /// it; else zero.
  Vec2 beyond_outline{0.0f};
  /// For normal-mapped surfaces (SurfaceMaterial::relief), local: tangent, bitangent and normal for the map's
  /// components, not normalized; zero if there are none. `ground` is the geometric normal, on the viewer's side.
  Mat3 relief{0.0f};
  Vec3 ground{0, 0, 1};
  bool back = false;  // seen from behind the mesh normal; uv, +x and +y are those of the front

  /// Place on a set of texture coordinates below kMaxSets; 0: `uv`.
  SitePlace place(size_t set) const { return set == 0 ? SitePlace{uv, footprint} : others[set - 1]; }

  /// The average of a repeating texture, and gray in place of a mesh's colors and of what a program computes: for
  /// tables and fits of a whole material.
  static SurfaceSite everywhere() {
    SurfaceSite site{.uv = Vec2(0.5f), .footprint = Mat2(1.0f)};
    site.others.fill(site.place(0));
    site.colors.fill(Rgb(0.5f));
    site.computed.fill(Rgb(0.5f));
    return site;
  }
};

// Filters that a path applies to the lobes of the surface it meets, to reduce noise.

/// Effect of Cycles' Filter Glossy and Reflective Caustics on microfacet lobes. Both bias the image. Measured materials
/// have no such lobes and are unaffected.
struct LobeFilter {
  float min_alpha = 0;        // minimum alpha of lobes; does not change their brightness
  bool diffuse_only = false;  // no reflection by microfacets; refraction stays
};

// Mip level and positions of the texture look-ups for a ray footprint.

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
