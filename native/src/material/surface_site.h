// Where on a surface, and over how much of it, a material is asked for.
#pragma once

#include <array>
#include <cstddef>

#include "sphere/vec.h"

namespace velour {

/// A place of a picture: `uv`, and the sides of the parallelogram about it that the ray stands for.
struct SitePlace {
  Vec2 uv{0.0f};
  Mat2 footprint{0.0f};
};

/// Of a material that varies over the surface (Material::varies); uniform ones do not look at it.
struct SurfaceSite {
  Vec2 uv{0.0f};  // the first coordinate along the local frame's +x; +y is the side that the second grows to
  /// Columns: the sides of the parallelogram about `uv` that the ray stands for, in texture coordinates. Zero: a point.
  /// Seen at a grazing angle it is long, but finite.
  Mat2 footprint{0.0f};
  /// The same on other sets of texture coordinates, of materials that look at several (place()).
  static constexpr size_t kMostSets = 4;  // `uv` included
  std::array<SitePlace, kMostSets - 1> others{};
  /// Colours of the mesh's corners, interpolated; of materials that look at them. Nothing is averaged over a footprint.
  static constexpr size_t kMostColorSets = 4;
  std::array<Rgb, kMostColorSets> colors{};
  /// Of BTFs of open structure whose outlines rays find for themselves (HoledBtfMaterial): from `uv` to its mirror
  /// image at an outline that is near enough for texels to reach over it; else zero.
  Vec2 beyond_outline{0.0f};
  /// Of surfaces with a normal map (SurfaceMaterial::relief), local: tangent, bitangent and normal that the map's
  /// components are along, not normalised; zero where there are none. And the geometric normal, on the viewer's side.
  Mat3 relief{0.0f};
  Vec3 ground{0, 0, 1};
  bool back =
      false;  // seen from the side that the mesh's normal does not point to; uv and +x, +y are those of the front

  /// On a set of texture coordinates, below kMostSets; 0: `uv`.
  SitePlace place(size_t set) const { return set == 0 ? SitePlace{uv, footprint} : others[set - 1]; }

  /// All of a texture that repeats, and grey in the place of a mesh's colours: what a table or a fit for a whole
  /// material looks at.
  static SurfaceSite everywhere() {
    SurfaceSite site{.uv = Vec2(0.5f), .footprint = Mat2(1.0f)};
    site.others.fill(site.place(0));
    site.colors.fill(Rgb(0.5f));
    return site;
  }
};

}  // namespace velour
