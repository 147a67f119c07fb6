// Tables of the albedo of rough GGX surfaces, shared by all materials.
#pragma once

#include "material/microfacet/ggx.h"
#include "math/sphere/vec.h"

namespace velour {

/// Reflected energy over roughness (alpha = roughness^2) and view cosine, so that no hit computes an integral. The
/// tables have the resolution and the linear interpolation of Blender 4.0 and newer, so that a layer passes as much
/// light to the ones below as in Blender. Arguments are clamped to [0, 1]. Thread-safe; built at first use, the
/// mean_rise() tables one index at a time.
namespace ggx_albedo {

/// Albedo of the lobe with perfectly reflecting facets, in (0, 1]: the remainder is lost between facets.
float of_white(float roughness, float cosine);
/// Cosine-weighted mean of of_white() over the hemisphere, 2 int albedo(mu) mu dmu.
float mean_of_white(float roughness);

/// Mean over visible facets of (F - F0) / (1 - F0) of a dielectric: how far its reflectance rises from the value at
/// normal incidence towards 1. `eta` and 1 / `eta` are the same.
float mean_rise(float roughness, float cosine, float eta);

/// Light that the facets of a lossless dielectric reflect and refract without meeting other facets, in (0, 1]. `eta` >
/// 0: relative index. As in Blender's tables, light that is refracted out of the surface again counts; only an `eta`
/// below 1 refracts so, at grazing angles.
float of_glass(float roughness, float cosine, float eta);
/// Cosine-weighted mean of of_glass() over the hemisphere.
float mean_of_glass(float roughness, float eta);

}  // namespace ggx_albedo

// Integrals over the microfacets visible from a view.

/// Quadrature of the mean over visible GGX normals [H18], for integrands symmetric about the xz plane, in which the
/// view lies. The integrand is smooth at any roughness. Arrays let compilers vectorize.
struct VisibleFacets {
  static constexpr int kCount = 24 * 24;
  float cosine[kCount];   // between view and facet
  float masking[kCount];  // G2 / G1 of the mirrored direction; 0: it is below the horizon

  /// Requires wv.y = 0.
  VisibleFacets(const Vec3& wv, const Vec2& alpha);
  /// Weights of the facets; they sum to 1.
  static const double* weights();
};

/// Calls `add(weight, cosine, masking)` for each facet.
template <class Add>
void for_visible_facets(const Vec3& wv, const Vec2& alpha, const Add& add) {
  const VisibleFacets facets(wv, alpha);
  const double* const weight = VisibleFacets::weights();
  for (int i = 0; i < VisibleFacets::kCount; ++i) add(weight[i], facets.cosine[i], facets.masking[i]);
}

// Interreflection between the facets of a rough surface.

/// Factors by which interreflection between facets scales a lobe at a view cosine; 1 unless it is GgxLobe::whole. The
/// shape remains that of one bounce, so f is not reciprocal. Follows Blender since 4.0.
class Interreflection {
 public:
  Interreflection(GgxLobe lobe, float roughness, float cosine) {
    if (lobe != GgxLobe::whole) return;
    albedo_ = ggx_albedo::of_white(roughness, cosine);
    mean_ = ggx_albedo::mean_of_white(roughness);
  }

  /// The same for glass, whose mean_fresnel below is its tint.
  static Interreflection of_glass(GgxLobe lobe, float roughness, float cosine, float eta) {
    Interreflection glass(GgxLobe::single, roughness, cosine);
    if (lobe != GgxLobe::whole) return glass;
    glass.albedo_ = ggx_albedo::of_glass(roughness, cosine, eta);
    glass.mean_ = ggx_albedo::mean_of_glass(roughness, eta);
    return glass;
  }

  /// Makes the albedo that of one or more bounces [KC17, appendix]. `mean_fresnel`: mean reflectance of the facets over
  /// a hemisphere, 2 int F mu dmu.
  Rgb gain(const Rgb& mean_fresnel) const {
    const Rgb more = mean_fresnel * mean_ / (1.0f - mean_fresnel * (1 - mean_));
    return 1.0f + more * ((1 - albedo_) / albedo_);
  }
  /// gain() relative to that of perfectly reflecting facets, which makes the albedo 1.
  Rgb gain_of_whole(const Rgb& mean_fresnel) const { return gain(mean_fresnel) * albedo_; }

 private:
  float albedo_ = 1, mean_ = 1;
};

}  // namespace velour
