// Position and footprint on a surface at which a material is evaluated.
#pragma once

#include <array>
#include <cstddef>
#include "math/sphere/vec.h"

namespace velour {

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

}  // namespace velour
