// Blender's Principled BSDF: its formula at a point, and the material.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>
#include "material/material.h"
#include "material/microfacet/ggx.h"
#include "material/microfacet/glass_lobe.h"
#include "material/surface_site.h"
#include "material/texture.h"
#include "math/sphere/vec.h"

namespace velour {

// Blender's Principled BSDF as a formula, for materials that were not measured.

/// Version of the Principled BSDF. Neither is both reciprocal and energy-conserving, but a scene must look as its
/// artist made it.
enum class PrincipledFormula {
  /// Blender 4.0 and newer, after the OpenPBR and Standard Surface models. A metal, with Schlick's Fresnel term lowered
  /// by the tint, beside a dielectric over a Lambertian base. The base receives what the dielectric transmits, averaged
  /// over the visible facets; this depends on the view angle alone, so f is not reciprocal. A clear coat on top
  /// attenuates in the same way, and so does sheen above it. A white material reflects all light.
  layered,
  /// Blender 2.7 to 3.6. One lobe, whose reflectance at normal incidence mixes those of the dielectric and the metal,
  /// added to Disney's diffuse base with its rise towards grazing angles [Bur12, Sec. 5.3]. Reciprocal, but reflects
  /// more light than arrives at such angles. Sheen and a clear coat are added without dimming what is below.
  disney,
};

/// The part of the material that f includes: the base (before 4.0 with its sheen), the reflection below the coat, that
/// of the coat, sheen above it, or glass.
enum class PrincipledPart { whole, base, specular, coat, sheen, glass };

/// Names and meanings of Blender's Principled BSDF. Colors are linear Rec. 709; values are in [0, 1] unless noted.
struct PrincipledParameters {
  Rgb base_color{0.8f, 0.8f, 0.8f};
  float metallic = 0;
  float roughness = 0.5f;               // alpha = roughness^2
  float specular = 0.5f;                // 0.5: index 1.5
  Rgb specular_tint{1.0f, 1.0f, 1.0f};  // tints a dielectric at normal incidence and a metal near 82 degrees
  float coat = 0;                       // weight of a dielectric layer on top, or of Disney's clear coat
  float coat_roughness = 0.03f;
  float coat_index = 1.5f;           // at least 1
  Rgb coat_tint{1.0f, 1.0f, 1.0f};   // transmittance of the coat at normal incidence, down and back
  float transmission = 0;            // share of glass in what is not metal
  float transmission_roughness = 0;  // Disney's: adds to that of refraction
  /// Index of the glass, > 0. Below 1 it also inverts that of the dielectric (layered).
  float index = 1.5f;
  float sheen = 0;  // weight of fuzz; may exceed 1
  float sheen_roughness = 0.5f;
  Rgb sheen_tint{1.0f, 1.0f, 1.0f};
  bool specular_of_index = false;  // `specular` 0.5 means the reflectance of `index`, not of 1.5
  PrincipledFormula formula = PrincipledFormula::layered;
  GgxLobe lobe = GgxLobe::whole;  // of metal and dielectric
  /// whole: since Blender 4.5. single: 4.0 to 4.4, which dim the layers below as a smooth coat does.
  GgxLobe coat_lobe = GgxLobe::whole;
  PrincipledPart part = PrincipledPart::whole;
};

/// Minimum rendered roughness, whose alpha is kMinGgxAlpha.
inline constexpr float kMinRoughness = 0.0316227766f;

/// Light that sheen and coat leave to the layers below them: the share that sheen does not
/// scatter, the share that the coat does not reflect, and for its tint Beer's law along the refracted ray. Follows
/// Blender since 4.0; 1 in Disney's formula. With filter.diffuse_only the coat does not reflect and only tints.
/// `cosine`: of the view with the normal of sheen; `coat_cosine`: with that of the coat.
Rgb through_top(const PrincipledParameters& parameters, float cosine, float coat_cosine, const LobeFilter& filter = {});

/// Fuzz above a surface since Blender 4.0: a linearly transformed cosine about the view's azimuth, fitted to scattering
/// in a layer of fibers [ZBC22], by tables measured in Cycles (scripts/sheen_table). `cosine` is that of the view.
/// Without albedo where Cycles leaves sheen out.
struct SheenLobe {
  float a = 1, b = 0, albedo = 0;

  SheenLobe() = default;
  SheenLobe(float roughness, float cosine);
};

/// State of the material for given parameters and a view, including all table look-ups:
/// f = diffuse D + lobe (at_normal + rise r + metal F) + coat coat_lobe F_coat + sheen S, with D, r, F and S of the
/// formulas. Glass is a GlassLobe of weight `glass`.
struct PrincipledPoint {
  Rgb diffuse;          // weight of the base over pi
  Rgb at_normal, rise;  // reflectance of the dielectric at normal incidence, and what it gains towards grazing angles
  Rgb metal;            // weight of the metal's reflectance; 0 in Disney's formula
  Rgb base_color, specular_tint;
  Vec2 alpha, coat_alpha;
  float eta, f0;           // dielectric: index, and untinted reflectance at normal incidence
  float coat, coat_eta;    // coat: weight of its lobe, index
  float roughness;         // at least kMinRoughness
  float view_rise;         // (1 - wv.z)^5, for Disney's base
  Rgb sheen, glass;        // weights
  SheenLobe sheen_lobe;    // not in Disney's formula
  Vec2 azimuth;            // unit, of the view
  float diffuse_end = 1;   // random numbers in [0, 1) below it sample the base
  float specular_end = 1;  // those below this metal and dielectric
  float coat_end = 1;      // those below this the coat
  float sheen_end = 1;     // those below this sheen, the rest glass
  float albedo = 0;        // approximate, of what does not leave by lobes without width
  PrincipledFormula formula;
  GgxLobe lobe;

  PrincipledPoint() = default;
  /// Requires wv.z > 0. Clamps parameters to their ranges. `glass_albedo`: GlassLobe::albedo of glass_of().
  PrincipledPoint(const PrincipledParameters& parameters, const Vec3& wv, const LobeFilter& filter = {},
                  float glass_albedo = 0);

  /// Tint of a metal: at most 1, since a tint does not brighten it.
  float metal_tint(int channel) const { return std::min(specular_tint[channel], 1.0f); }

  /// Factor of the lobe at the cosine between wv and a facet.
  Rgb reflectance(float cosine) const;

 private:
  void set_layered(const PrincipledParameters& p, float cosine, const LobeFilter& filter);
  void set_disney(const PrincipledParameters& p, float cosine, const LobeFilter& filter);
  void set_shares(float cosine, float glass_albedo);
  /// Mean of (F - f0) / (1 - f0) of the dielectric over a hemisphere of light.
  float mean_rise() const;
};

/// The glass of the material.
GlassParameters glass_of(const PrincipledParameters& parameters);

// Blender's Principled BSDF, uniform or textured.

/// A texture in place of a parameter.
template <class T>
struct PrincipledTexture {
  T PrincipledParameters::*parameter;
  TextureSlot<T> slot;
};

struct PrincipledTextures {
  TextureSlot<Rgb> base_color{};
  TextureSlot<float> metallic{}, roughness{}, alpha{};
  std::vector<PrincipledTexture<float>> numbers{};  // of other parameters
  std::vector<PrincipledTexture<Rgb>> colors{};

  bool varies() const {
    return base_color.given() || metallic.given() || roughness.given() || !numbers.empty() || !colors.empty();
  }
  bool any() const { return varies() || alpha.given(); }
  /// `parameters` with those that have a texture replaced.
  PrincipledParameters at(const SurfaceSite& site, PrincipledParameters parameters) const;
  /// `parameters` with the textured ones of coat, sheen and transmission 1, and metallic 0: what may be somewhere.
  PrincipledParameters anywhere(PrincipledParameters parameters) const;
  /// Leaves `parameter` at its own value.
  void remove(float PrincipledParameters::*parameter);
};

/// Samples the cosine, the normals of the lobe or the coat, sheen or glass, in proportion to their albedos. Isotropic.
class PrincipledMaterial final : public Material {
 public:
  /// A base color and alpha are averaged over the footprint; textures of several parameters, whose averages would make
  /// another material, are read at a point. `alpha` applies if it has no texture.
  explicit PrincipledMaterial(const PrincipledParameters& parameters, const PrincipledTextures& textures = {},
                              float alpha = 1);

  const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                              ScratchArena& arena) const override;

  bool isotropic() const override { return true; }
  bool transmits() const override;
  bool varies() const override { return textures_.any(); }
  bool opaque() const override { return !textures_.alpha.given() && alpha_ >= 1; }
  float alpha(const SurfaceSite& site) const override;

 private:
  const PrincipledParameters parameters_;
  const PrincipledTextures textures_;
  const float alpha_;
};

/// f and sampling density at `point` of each direction; the batch is padded. SIMD, dispatched at run time.
void eval_principled(const PrincipledPoint& point, const Vec3& wv, const DirectionBatch& wl, RgbBatch& f,
                     ScalarBatch& pdf);

std::shared_ptr<const Material> make_principled_material(const PrincipledParameters& parameters,
                                                         const PrincipledTextures& textures = {}, float alpha = 1);

}  // namespace velour
