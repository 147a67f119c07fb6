// Materials whose normal a picture gives.
#pragma once

#include <memory>

#include "material/material.h"
#include "material/texture_slot.h"

namespace velour {

/// Colours from 0 to 1 are components from -1 to 1 along tangent, bitangent and normal of the surface
/// (SurfaceSite::relief).
struct NormalMap {
  TextureSlot<Rgb> texture{};
  /// Of the tilt: 0 is the surface as it is, 1 the picture, more exaggerates.
  float strength = 1;
};

/// What of f is diffuse: there the light fades out softly before the surface's own horizon, as in Cycles ([CLB19], Eq.
/// 3 and the smoothing after it), where it would end in a hard line.
enum class DiffusePart { none, all, base_of_principled };

/// `material`, uniform or textured, about the mapped normal: its f times the ratio of the cosines with the mapped and
/// with the surface's own normal, 0 where light or viewer are behind either. So that what a mirror would reflect comes
/// from above the geometric surface, the normal is turned towards that one as far as it needs. Where the surface has no
/// relief the material is as it is.
std::shared_ptr<const Material> make_normal_mapped(std::shared_ptr<const Material> material, const NormalMap& map,
                                                   DiffusePart diffuse);

/// What the light keeps of a diffuse f about a normal whose cosine with the surface's own is `tilt`: `own` and `mapped`
/// are the light's cosines with both.
float terminator_softening(float own, float mapped, float tilt);

/// Unit `normal`, or one between it and unit `ground` about which the mirror image of unit `wv` is above `ground`: by a
/// cosine of 0.01, or 0.9 of wv's own where that is less. `wv` is above `ground`.
Vec3 with_mirror_above(const Vec3& normal, const Vec3& ground, const Vec3& wv);

}  // namespace velour
