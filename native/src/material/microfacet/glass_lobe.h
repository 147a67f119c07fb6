// Light that the microfacets of a dielectric reflect and refract, prepared for a view.
#pragma once

#include "material/material.h"
#include "material/microfacet/ggx.h"

namespace velour {

/// How light is divided between reflection and refraction.
enum class GlassFresnel {
  /// By the angle with each facet. Glass BSDF since Blender 3.6, Refraction and Principled BSDF since 4.0.
  facets,
  /// By the angle of the view with the surface, without total reflection by facets: earlier versions.
  surface,
};

struct GlassParameters {
  Rgb reflected{1.0f}, refracted{1.0f};  // tints of both parts; 0: the part is absent
  Rgb at_normal{1.0f};                   // factor of the reflectance at normal incidence
  float roughness = 0;                   // GGX alpha is its square
  float refraction_roughness = 0;        // the same for the refracted part, with GlassFresnel::surface
  float index = 1.45f;                   // of refraction, behind the surface relative to in front of it; > 0
  bool only_refracts = false;            // Refraction BSDF: no share of the light is reflected
  GlassFresnel fresnel = GlassFresnel::facets;
  GgxLobe lobe = GgxLobe::whole;
};

/// f = F D G / (4 cos cos) for light on the viewer's side, and for light beyond it
///   (1 - F) D G eta^2 |h.wv h.wl| / (|s|^2 cos cos),  s = -(eta wl + wv),  h = s / |s|
/// [WMLT07, Eqs. 20 and 21], without the factor by which radiance is compressed: the light behind is that of the other
/// medium over the square of its index, as in Cycles. So f(wv, wl) = eta^2 f(wl, wv) across the surface, and a glass
/// that absorbs nothing lets all light through. With GgxLobe::whole both are scaled by Interreflection.
///
/// Samples the visible normals, and reflects or refracts in them by F. Where h faces away from the surface or from
/// either direction, there is no facet and f is 0. Cycles evaluates f and the density there as elsewhere, although it
/// samples no such direction, which brightens rough refraction under sampled lights; so does a lobe that is `of_path`
/// and not `facets_only` (PrepareOptions). There the density is above 0 but that of no sample.
class GlassLobe {
 public:
  /// Requires wv.z > 0. `back`: seen from behind, where the relative index is the reciprocal.
  GlassLobe(const GlassParameters& parameters, const Vec3& wv, bool back, const PrepareOptions& options);

  PreparedBrdf::Reflection eval(const Vec3& wl) const {
    return wl.z > 0 ? reflection(wl) : wl.z < 0 ? refraction(wl) : PreparedBrdf::Reflection{Rgb(0.0f), 0.0f};
  }
  /// (0, 0, 0) where the light of a facet does not leave the surface.
  Vec3 sample(const Vec2& u) const;
  /// Adds the lobes without width, each scaled by `weight`.
  void add_deltas(const Rgb& weight, DeltaLobes& lobes) const;

  /// Approximate albedo (luminance) of what eval() describes.
  float albedo() const { return albedo_; }

 private:
  struct Divided {
    Rgb reflected, refracted;
    float share;  // probability of reflection
  };
  /// Division by a facet whose cosine with the view is `cosine` >= 0.
  Divided divide(float cosine) const;
  PreparedBrdf::Reflection reflection(const Vec3& wl) const;
  PreparedBrdf::Reflection refraction(const Vec3& wl) const;
  Vec3 refracted(const Vec3& normal, float cosine) const;

  Vec3 wv_;
  GlassParameters p_;
  float eta_;                       // relative index, other side over the viewer's
  float f0_, surface_;              // reflectance at normal incidence, and at the view's angle with the surface
  Vec2 alpha_, refraction_alpha_;   // slope roughness
  Rgb gain_{1.0f};                  // of Interreflection
  bool mirrors_, passes_straight_;  // reflection, refraction are delta lobes
  bool as_cycles_;
  float share_ = -1;  // probability of reflection by the surface's angle
  float albedo_;
};

}  // namespace velour
