// Normal-mapped materials.
#pragma once

#include <memory>

#include "material/material.h"
#include "material/texture.h"

namespace velour {

/// Correction of artifacts at steep mapped normals. Cycles uses `turned` in Blender 3, `faded` in 4.0 to 4.4 and
/// `shadowed` since 4.5; since 4.2 a material may choose `none`.
enum class ReliefCorrection {
  turned,    // mirror directions are kept above the ground; diffuse light fades by terminator_softening()
  faded,     // as `turned`, but normals of the diffuse part stay
  shadowed,  // as `faded`, but diffuse light fades by relief_shadowing()
  none       // no correction
};

/// Parts of a material that a normal map treats differently.
enum class ReliefPart {
  lobe,
  diffuse,
  base  // Lambertian; depends on the view only by what the lobe above transmits, about that lobe's normal
};

/// Colors in [0, 1] encode components in [-1, 1] along tangent, bitangent and normal of the surface
/// (SurfaceSite::relief). An output of a program is the normal itself; `strength` does not apply to it.
struct NormalMap {
  TextureSlot<Rgb> texture{};
  /// Strength of the tilt. 0: unmapped surface, 1: as in the texture, more: exaggerated.
  float strength = 1;
  ReliefCorrection correction = ReliefCorrection::turned;
  bool of_surface = false;  // no texture: the normal is that of the surface, and only corrected

  /// Unit normal of a lobe, or of a diffuse part, in the local frame, for the view `wv`.
  Vec3 normal(bool is_lobe, const Vec3& wv, const SurfaceSite& site) const;
};

/// Corrects interpolated normals, which on coarse meshes are far from those of the faces.
inline NormalMap surface_normal(ReliefCorrection correction) { return {.correction = correction, .of_surface = true}; }

/// Least cosine of a view with a mapped normal.
inline constexpr float kMinViewCosine = 1e-3f;

/// `wv`, moved up to kMinViewCosine if it is lower.
inline Vec3 above_horizon(const Vec3& wv) {
  return wv.z < kMinViewCosine ? glm::normalize(Vec3(wv.x, wv.y, kMinViewCosine)) : wv;
}

/// Applies a normal map to `material`, uniform or textured: f about the mapped normal times the ratio of the light's
/// cosines with the mapped and the surface normal, 0 where the light is behind either. A view behind the mapped normal
/// is moved to its horizon. Unless the correction excludes it, the normal is turned towards the geometric normal until
/// the mirror image of the view is above the geometric surface. Diffuse light fades out before the surface's own
/// horizon, where it would otherwise end in a hard line. Without SurfaceSite::relief a map changes nothing.
std::shared_ptr<const Material> make_normal_mapped(std::shared_ptr<const Material> material, const NormalMap& map,
                                                   ReliefPart part);

/// Factor of a diffuse f about a normal whose cosine with the surface normal is `tilt`. `own` and `mapped`: cosines of
/// the light with the surface and the mapped normal. [CLB19], Eq. 3 and the smoothing after it.
float terminator_softening(float own, float mapped, float tilt);
/// Alternative factor: the unshadowed share of GGX facets whose roughness follows the tilt ([CLS19]).
float relief_shadowing(float own, float tilt);

/// Unit `normal`, turned towards unit `ground` until the mirror image of unit `wv` is above `ground` by a cosine of
/// 0.01, or 0.9 of wv's own if that is less. `wv` must be above `ground`.
Vec3 with_mirror_above(const Vec3& normal, const Vec3& ground, const Vec3& wv);

}  // namespace velour
