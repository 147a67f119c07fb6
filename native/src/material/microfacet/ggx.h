// The GGX microfacet distribution, and tables of its directional albedo.
#pragma once

#include <algorithm>
#include "math/sphere/number_math.h"
#include "math/sphere/vec.h"

namespace velour {

// The GGX microfacet distribution with Smith's height-correlated masking: Heitz 2014, JCGT 3(2), and sampling of the
// visible normals: Heitz 2018, JCGT 7(4). Directions are unit, in the local frame; `alpha` > 0 is the slope roughness
// along x and along y.

/// Minimum slope roughness: a mirror's density is not a function, and below this a lobe is as sharp as any light.
inline constexpr float kMinGgxAlpha = 1e-3f;

/// How GGX facets shadow each other, and whether light between them is accounted for.
enum class GgxLobe {
  whole,      // height-correlated, scaled to restore the energy lost by single scattering: Multiscatter GGX of 4.0
  single,     // height-correlated: GGX of Blender 3.5 and newer
  separable,  // both directions shadowed independently: GGX of Blender 3.4 and older
};

// Scalar versions; sources that Highway compiles include the same formulas for vectors.
#include "material/microfacet/ggx_formulas-inl.h"

inline float ggx_brdf_without_fresnel(const DirectionPair& w, const Vec3& h, const Vec2& alpha) {
  return ggx_brdf_without_fresnel(w.wv, w.wl, h, alpha);
}

/// Derivatives of log(ggx_brdf_without_fresnel) with respect to log(alpha.x) and log(alpha.y).
inline Vec2 ggx_log_slope(const DirectionPair& w, const Vec3& h, const Vec2& alpha) {
  const float length_v = ggx_projected_length(w.wv, alpha), length_l = ggx_projected_length(w.wl, alpha);
  const float bottom = w.wl.z * length_v + w.wv.z * length_l;
  const float spread = ggx_spread(h, alpha), ratio = alpha.y / alpha.x;
  const float along_x = h.x * h.x * ratio, along_y = h.y * h.y / ratio;
  const float facing = spread - along_x - along_y;
  const auto masking = [&](float a, float v, float l) {
    return a * a * (w.wl.z * v * v / length_v + w.wv.z * l * l / length_l) / bottom;
  };
  return {1 - 2 * (facing + along_y - along_x) / spread - masking(alpha.x, w.wv.x, w.wl.x),
          1 - 2 * (facing + along_x - along_y) / spread - masking(alpha.y, w.wv.y, w.wl.y)};
}

/// Samples a microfacet normal visible from `wv` (Heitz 2018, Listing 1).
inline Vec3 sample_ggx_visible_normal(const Vec3& wv, const Vec2& alpha, const Vec2& u) {
  const Vec3 stretched = glm::normalize(Vec3(alpha.x * wv.x, alpha.y * wv.y, wv.z));
  const float across_sq = stretched.x * stretched.x + stretched.y * stretched.y;
  const Vec3 t1 = across_sq > 0 ? Vec3(-stretched.y, stretched.x, 0) / std::sqrt(across_sq) : Vec3(1, 0, 0);
  const Vec3 t2 = glm::cross(stretched, t1);
  const float r = std::sqrt(u.x), phi = 2 * kPi * u.y;
  const float p1 = r * std::cos(phi);
  const float s = 0.5f * (1 + stretched.z);
  const float p2 = (1 - s) * std::sqrt(std::max(0.0f, 1 - p1 * p1)) + s * r * std::sin(phi);
  const Vec3 n = p1 * t1 + p2 * t2 + std::sqrt(std::max(0.0f, 1 - p1 * p1 - p2 * p2)) * stretched;
  return glm::normalize(Vec3(alpha.x * n.x, alpha.y * n.y, std::max(0.0f, n.z)));
}

/// Reflectance of a surface that reflects `f0` at normal and `f90` at grazing incidence (Schlick 1994, Eq. 15, where
/// f90 is 1).
inline Rgb schlick_fresnel(const Rgb& f0, float cosine, const Rgb& f90 = Rgb(1)) {
  return f0 + (f90 - f0) * schlick_share(cosine);
}

// Tables of the albedo of rough GGX surfaces, shared by all materials.

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
