// Materials whose normal a picture gives.
#pragma once

#include <memory>

#include "material/material.h"
#include "material/texture_slot.h"

namespace velour {

/// What keeps steep normals from showing what cannot be there: in Cycles of Blender 3 the first, of Blender 4.0 to
/// 4.4 the second, since 4.5 the third; from 4.2 on a material may ask for the last.
enum class ReliefCorrection {
  turned,    // mirror images stay above the ground; diffuse light fades out by terminator_softening()
  faded,     // the same, but normals of what is diffuse stay
  shadowed,  // the same, but diffuse light fades out by relief_shadowing()
  none       // normals and light stay
};

/// What a relief does not do the same to.
enum class ReliefPart {
  lobe,
  diffuse,
  base  // Lambertian: of the view it needs no more than how much the lobe above it, about that one's normal, leaves it
};

/// Colours from 0 to 1 are components from -1 to 1 along tangent, bitangent and normal of the surface
/// (SurfaceSite::relief).
struct NormalMap {
  TextureSlot<Rgb> texture{};
  /// Of the tilt: 0 is the surface as it is, 1 the picture, more exaggerates.
  float strength = 1;
  ReliefCorrection correction = ReliefCorrection::turned;
};

/// `material`, uniform or textured, about the mapped normal: its f times the ratio of the cosines with the mapped and
/// with the surface's own normal, 0 where the light is behind either; a viewer behind the mapped one sees what is seen
/// at its horizon. So that what a mirror would reflect comes from above the geometric surface, the normal is turned
/// towards that one as far as it needs, unless the correction leaves it. What is diffuse fades out softly before the
/// surface's own horizon, where it would end in a hard line. Where the surface has no relief the material
/// is as it is.
std::shared_ptr<const Material> make_normal_mapped(std::shared_ptr<const Material> material, const NormalMap& map,
                                                   ReliefPart part);

/// What the light keeps of a diffuse f about a normal whose cosine with the surface's own is `tilt`: `own` and `mapped`
/// are the light's cosines with both. [CLB19], Eq. 3 and the smoothing after it.
float terminator_softening(float own, float mapped, float tilt);
/// The same as the share that facets of GGX, as rough as the tilt is steep, do not shadow ([CLS19]).
float relief_shadowing(float own, float tilt);

/// Unit `normal`, or one between it and unit `ground` about which the mirror image of unit `wv` is above `ground`: by a
/// cosine of 0.01, or 0.9 of wv's own where that is less. `wv` is above `ground`.
Vec3 with_mirror_above(const Vec3& normal, const Vec3& ground, const Vec3& wv);

}  // namespace velour
