// A GGX lobe with free reflectances over a diffuse base, as a renderer without measured materials would use, and its
// importance sampler.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include "math/sphere/directions.h"
#include "math/sphere/vec.h"

namespace velour {

// Directional albedo of a specular lobe as a table over the cosine.

/// Reflectance at the microfacet as a function of the cosine with its normal.
using Fresnel = std::function<float(float cosine)>;

/// Linear in sqrt(cosine) between entries, where grazing albedos change fast. Immutable.
class SpecularAlbedo {
 public:
  SpecularAlbedo() = default;
  /// Albedo of the GGX lobe of roughness `alpha` by quadrature, for views in the xz plane.
  SpecularAlbedo(const Vec2& alpha, const Fresnel& fresnel);
  float at(float cosine) const;

 private:
  static constexpr int kEntries = 64;
  std::array<float, kEntries> albedo_{};
};

class Material;

/// f = diffuse / pi + F G2 D / (4 wl.z wv.z), F = schlick_fresnel(f0, wv.h, f90). Linear Rec. 709, >= 0. f90 is free
/// because few measurements rise to 1 at grazing angles; for the same reason the lobe does not dim the base.
struct GgxParameters {
  Vec2 alpha{0.5f};  // slope roughness along x and along y
  Rgb f0{0.0f}, f90{0.0f}, diffuse{0.0f};
};

/// f in 1/sr without cosine; both directions above the horizon.
Rgb ggx_model(const GgxParameters& parameters, const DirectionPair& w);

/// View-dependent sampling state.
struct GgxPoint {
  Vec3 wv;
  float cosine_share;  // probability of cosine sampling: base and defensive share
  float lobe_scale;    // density of the other component = lobe_scale (|s|^2 / ggx_spread(s))^2 with s = wl + wv
};

/// Samples the visible normals or the cosine in proportion to their albedos at the view, and 5 % cosine in any case,
/// the same defensive share as for lobes and tables. Immutable; thread-safe; no allocation after construction.
class GgxSampler {
 public:
  explicit GgxSampler(const GgxParameters& parameters);

  /// Requires wv.z > 0.
  void prepare(const Vec3& wv, GgxPoint& point) const;
  /// The direction may lie below the horizon.
  Vec3 sample(const GgxPoint& point, const Vec2& u) const;
  /// Density of `sample` per solid angle, at each direction of the padded batch.
  void pdf(const GgxPoint& point, const DirectionBatch& wl, ScalarBatch& pdf) const;

 private:
  float specular_albedo(const Vec3& wv) const;

  Vec2 alpha_;
  float diffuse_;                     // luminance
  float specular_;                    // luminance of the brighter of f0 and f90: the scale of the tables
  SpecularAlbedo along_x_, along_y_;  // albedos for views in the xz and yz planes
};

/// Material of the fitted lobe itself.
std::shared_ptr<const Material> make_ggx_material(const GgxParameters& parameters);

// Density of GgxSampler over a batch of directions.

/// pdf[i] = cosine_share max(wl.z, 0) / pi + lobe_scale (|s|^2 / ggx_spread(s))^2 where s = wl + wv points up. The
/// second term is pdf_ggx_reflection without a square root: spread and |s|^2 scale alike, so s is not normalized. The
/// batch is padded. SIMD, dispatched at run time.
void ggx_mixture_pdf(const GgxPoint& point, const Vec2& alpha, const DirectionBatch& wl, ScalarBatch& pdf);

}  // namespace velour
