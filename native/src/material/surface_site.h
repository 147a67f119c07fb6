// Where on a surface, and over how much of it, a material is asked for.
#pragma once

#include "sphere/vec.h"

namespace velour {

/// Of a material that varies over the surface (Material::varies); uniform ones do not look at it.
struct SurfaceSite {
  Vec2 uv{0.0f};  // the first coordinate along the local frame's +x; +y is the side that the second grows to
  /// Columns: the sides of the parallelogram about `uv` that the ray stands for, in texture coordinates. Zero: a point.
  /// Seen at a grazing angle it is long, but finite.
  Mat2 footprint{0.0f};
  /// Of BTFs of open structure whose outlines rays find for themselves (HoledBtfMaterial): from `uv` to its mirror
  /// image at an outline that is near enough for texels to reach over it; else zero.
  Vec2 beyond_outline{0.0f};
  /// Of surfaces with a normal map (SurfaceMaterial::relief), local: tangent, bitangent and normal that the map's
  /// components are along, not normalised; zero where there are none. And the geometric normal, on the viewer's side.
  Mat3 relief{0.0f};
  Vec3 ground{0, 0, 1};
  bool back =
      false;  // seen from the side that the mesh's normal does not point to; uv and +x, +y are those of the front

  /// All of a texture that repeats: what a table or a fit for a whole material looks at.
  static SurfaceSite everywhere() { return {.uv = Vec2(0.5f), .footprint = Mat2(1.0f)}; }
};

}  // namespace velour
