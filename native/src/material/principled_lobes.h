// Blender's Principled material as a formula: what an artist has where nothing was measured.
#pragma once

#include "material/specular_albedo.h"
#include "sphere/vec.h"

namespace velour {

/// Names and meanings of Blender's Principled BSDF; colours linear Rec. 709, all in [0, 1].
struct PrincipledParameters {
  Rgb base_color{0.8f, 0.8f, 0.8f};
  float metallic = 0;
  float roughness = 0.5f;               // alpha = roughness^2
  float specular = 0.5f;                // 0.5: index 1.5
  Rgb specular_tint{1.0f, 1.0f, 1.0f};  // of a dielectric's reflectance at normal incidence, a metal's near 82 degrees
  float coat = 0;                       // weight of a clear dielectric layer of index 1.5 on top
  float coat_roughness = 0.03f;
};

/// Roughness of kMinGgxAlpha, the least that is rendered.
inline constexpr float kMinRoughness = 0.0316227766f;
inline constexpr float kCoatIndex = 1.5f;

/// What f is made of before it gets its colours, 1/sr without cosine; of one direction, or of several side by side.
template <class T>
struct PrincipledParts {
  T fixed;       // coat, and the dielectric's rise towards grazing angles
  T dielectric;  // reflectance at normal incidence: times the tint
  T diffuse;     // times the base colour
  T metal;       // the lobe: times its Fresnel term
  T cosine;      // between wv and h
};

/// A metal, and a dielectric over a diffuse base, blended by `metallic`, under a clear coat. Isotropic.
///
/// The base receives what the layers above let through: base / pi (1 - E(wv)) (1 - E(wl)) / (1 - E_mean), with E their
/// albedo (Kelemen & Szirmay-Kalos 2001, Sec. 2.2). It is reciprocal, and a white base under any dielectric reflects
/// exactly all light. The coat's albedo dims what lies under it as in Blender, by the darker of both directions where
/// Blender takes the viewer's: reciprocal, the same at the mirror direction, and never more light than arrives.
/// Immutable, thread-safe.
class PrincipledLobes {
 public:
  /// Black, to be set.
  PrincipledLobes() = default;
  explicit PrincipledLobes(const PrincipledParameters& parameters);
  /// The same for other parameters; tables of albedos are made anew only where they differ.
  PrincipledLobes with(const PrincipledParameters& parameters) const;

  /// Those of `parameters`, which differ from those of `a` and `b` in base colour, metallic and roughness only; the
  /// albedos are (1 - share) of a's and share of b's.
  void blend(const PrincipledParameters& parameters, const PrincipledLobes& a, const PrincipledLobes& b, float share);

  /// What the view decides. `wv.z > 0`.
  struct View {
    Vec3 wv;
    float diffuse_scale;
    float through;  // the share of light that the coat lets pass
  };
  View view(const Vec3& wv) const;
  /// Albedo of a white base.
  float base_albedo(const View& view) const { return kPi * (1 - top_.mean()) * view.diffuse_scale; }

  /// What all directions share (principled_formulas-inl.h); the tables are those of the lobes.
  struct Layers {
    Vec2 alpha, coat_alpha;
    float eta, f0, metallic, coat;
    const SpecularAlbedo::Table* coat_albedo;
    const SpecularAlbedo::Table* top_albedo;
  };
  Layers layers() const;

  using Parts = PrincipledParts<float>;
  /// `wl.z > 0`; `h` the half vector, 0 for opposed directions.
  Parts parts(const View& view, const Vec3& wl, const Vec3& h) const;

  /// f of one colour.
  static float value(const Parts& parts, float base_color, float specular_tint);
  Rgb value(const Parts& parts) const;

  /// Within their ranges; roughnesses at least kMinRoughness.
  const PrincipledParameters& parameters() const { return parameters_; }
  Vec2 alpha() const { return Vec2(parameters_.roughness * parameters_.roughness); }
  Vec2 coat_alpha() const { return Vec2(parameters_.coat_roughness * parameters_.coat_roughness); }
  /// Albedo of the coat alone; what passes it is 1 minus that.
  float coat_albedo(float cosine) const { return parameters_.coat * coat_.at(cosine); }
  /// Of the dielectric under the coat.
  float dielectric_albedo(const View& view) const { return view.through * dielectric_.at(view.wv.z); }
  /// Luminance of the reflectance of metal and dielectric at a microfacet.
  float fresnel_luminance(float cosine) const;

 private:
  void make_tables(bool dielectric, bool coat);

  PrincipledParameters parameters_;
  float eta_ = 1, f0_ = 0;                  // of the dielectric
  SpecularAlbedo dielectric_, coat_, top_;  // top_: coat and dielectric together
};

}  // namespace velour
