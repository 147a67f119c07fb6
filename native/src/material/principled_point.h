// Blender's Principled material as a formula: what an artist has where nothing was measured.
#pragma once

#include <algorithm>

#include "material/ggx.h"
#include "material/lobe_filter.h"
#include "sphere/vec.h"

namespace velour {

/// Whose Principled BSDF. Neither is reciprocal and keeps energy at once, but a scene is to look as it was made to
/// look.
enum class PrincipledFormula {
  /// Blender 4.0 and newer, after the OpenPBR and Standard Surface models. A metal with Schlick's Fresnel term bent
  /// down by the tint, beside a dielectric of which Lambert's base gets what its mean over the visible facets lets
  /// through,
  /// by the viewer's angle alone, so it is not reciprocal; under a clear coat, the same way. White reflects all light.
  layered,
  /// Blender 2.7 to 3.6. One lobe whose reflectance at normal incidence is mixed of the dielectric's and the metal's,
  /// added to Disney's diffuse base with its rise towards grazing angles [Bur12, Sec. 5.3]: reciprocal, and at such
  /// angles more light than arrives. There is no coat.
  disney,
};

/// The part of the material that f is: the base, the reflection of what lies below the coat, or the coat's.
enum class PrincipledPart { whole, base, specular, coat };

/// Names and meanings of Blender's Principled BSDF; colours linear Rec. 709, all in [0, 1].
struct PrincipledParameters {
  Rgb base_color{0.8f, 0.8f, 0.8f};
  float metallic = 0;
  float roughness = 0.5f;               // alpha = roughness^2
  float specular = 0.5f;                // 0.5: index 1.5
  Rgb specular_tint{1.0f, 1.0f, 1.0f};  // of a dielectric's reflectance at normal incidence, a metal's near 82 degrees
  float coat = 0;                       // weight of a dielectric layer on top
  float coat_roughness = 0.03f;
  float coat_index = 1.5f;          // at least 1
  Rgb coat_tint{1.0f, 1.0f, 1.0f};  // what the coat lets through straight down and back
  PrincipledFormula formula = PrincipledFormula::layered;
  GgxLobe lobe = GgxLobe::whole;  // of metal and dielectric
  /// whole: since Blender 4.5. single: 4.0 to 4.4, which dim what is below as a smooth coat does.
  GgxLobe coat_lobe = GgxLobe::whole;
  PrincipledPart part = PrincipledPart::whole;
};

/// Roughness of kMinGgxAlpha, the least that is rendered.
inline constexpr float kMinRoughness = 0.0316227766f;

/// What the coat leaves to the layers below it, seen at a cosine with the normal: Beer's law along the refracted ray
/// for the tint, and the share that it does not reflect. Blender's, since 4.0.
/// Without its lobe, where only diffuse light is asked for, the coat is but tinted.
Rgb through_coat(const PrincipledParameters& parameters, float cosine, const LobeFilter& filter = {});

/// What the parameters and a view decide, all that depends on tables with it:
/// f = diffuse D + lobe (at_normal + rise r + metal F) + coat coat_lobe F_coat, with D, r and F of the formulas.
struct PrincipledPoint {
  Rgb diffuse;          // weight of the base over pi
  Rgb at_normal, rise;  // reflectance of the dielectric at normal incidence, and what it gains towards grazing angles
  Rgb metal;            // weight of the metal's reflectance; 0 in Disney's formula
  Rgb base_color, specular_tint;
  Vec2 alpha, coat_alpha;
  float eta, f0;           // of the dielectric: index, and reflectance at normal incidence without a tint
  float coat, coat_eta;    // weight of its lobe, its index
  float roughness;         // of Disney's base
  float view_rise;         // (1 - wv.z)^5 of the same
  float diffuse_end = 1;   // samples below it, of random numbers in [0, 1), are drawn from the base
  float specular_end = 1;  // those below this from metal and dielectric, the rest from the coat
  PrincipledFormula formula;
  GgxLobe lobe;

  PrincipledPoint() = default;
  /// `wv.z > 0`. Takes parameters beyond their ranges for those at the ends.
  PrincipledPoint(const PrincipledParameters& parameters, const Vec3& wv, const LobeFilter& filter = {});

  /// Of a metal, which a tint does not brighten.
  float metal_tint(int channel) const { return std::min(specular_tint[channel], 1.0f); }

  /// What multiplies the lobe, at the cosine between wv and a facet.
  Rgb reflectance(float cosine) const;

 private:
  void set_layered(const PrincipledParameters& p, float cosine, const LobeFilter& filter);
  void set_disney(const PrincipledParameters& p, float cosine, const LobeFilter& filter);
  void set_shares(float cosine);
  /// How far the dielectric's reflectance is from f0 towards 1, in the mean over a hemisphere of light.
  float mean_rise() const;
};

}  // namespace velour
