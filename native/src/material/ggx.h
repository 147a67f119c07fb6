// The GGX microfacet distribution with Smith's height-correlated masking: Heitz 2014, JCGT 3(2), and sampling of the
// visible normals: Heitz 2018, JCGT 7(4). Directions are unit, in the local frame; `alpha` > 0 is the slope roughness
// along x and along y.
#pragma once

#include <algorithm>

#include "sphere/vec.h"

namespace velour {

/// A mirror's density is no function; below this a lobe is as sharp as any light we have.
inline constexpr float kMinGgxAlpha = 1e-3f;

/// |v|^2 in the space where the microsurface is a sphere, times alpha.x alpha.y: D = alpha.x alpha.y / (pi
/// spread(h)^2). Homogeneous of degree 2, so that a half vector need not be normalised: see pdf_ggx_reflection. In
/// sines, not in 1 - cosine squared, which loses a sharp peak.
inline float ggx_spread(const Vec3& v, const Vec2& alpha) {
  const float ratio = alpha.y / alpha.x;
  return v.x * v.x * ratio + v.y * v.y / ratio + alpha.x * alpha.y * (v.z * v.z);
}

/// Density D of microfacet normals per solid angle of h, so that the integral of D h.z is 1.
inline float ggx_distribution(const Vec3& h, const Vec2& alpha) {
  const float spread = ggx_spread(h, alpha);
  return h.z > 0 ? alpha.x * alpha.y / (kPi * spread * spread) : 0;
}

/// w.z (1 + 2 Lambda(w)): the square root that all of Smith's masking terms share.
inline float ggx_projected_length(const Vec3& w, const Vec2& alpha) {
  const float x = alpha.x * w.x, y = alpha.y * w.y;
  return std::sqrt(w.z * w.z + x * x + y * y);
}

/// G2 / (4 wl.z wv.z), in 1/sr with D: the specular BRDF without its Fresnel term. Both directions above the horizon.
inline float ggx_brdf_without_fresnel(const DirectionPair& w, const Vec3& h, const Vec2& alpha) {
  const float bottom = w.wl.z * ggx_projected_length(w.wv, alpha) + w.wv.z * ggx_projected_length(w.wl, alpha);
  return 0.5f * ggx_distribution(h, alpha) / bottom;
}

/// Derivatives of log(ggx_brdf_without_fresnel) by log(alpha.x) and log(alpha.y).
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

/// A normal drawn from the normals visible from `wv` (Heitz 2018, Listing 1).
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

/// The part of pdf_ggx_reflection that the view alone decides: times 1 / ggx_spread(h)^2, it is that density.
inline float pdf_ggx_reflection_scale(const Vec3& wv, const Vec2& alpha) {
  return 0.5f * alpha.x * alpha.y / (kPi * (wv.z + ggx_projected_length(wv, alpha)));
}

/// Density, per solid angle of the mirrored wl, of a visible normal h: G1 D / (4 wv.z).
inline float pdf_ggx_reflection(const Vec3& wv, const Vec3& h, const Vec2& alpha) {
  const float spread = ggx_spread(h, alpha);
  return h.z > 0 ? pdf_ggx_reflection_scale(wv, alpha) / (spread * spread) : 0;
}

/// Unpolarised reflectance of a smooth dielectric of relative index `eta` >= 1 from outside, `cosine` in [0, 1].
inline float dielectric_fresnel(float cosine, float eta) {
  if (eta <= 1) return 0;
  const float inside = std::sqrt(eta * eta - 1 + cosine * cosine) / eta;  // cosine of the refracted ray
  const float parallel = (eta * cosine - inside) / (eta * cosine + inside);
  const float perpendicular = (cosine - eta * inside) / (cosine + eta * inside);
  return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

/// (1 - cosine)^5: the share of the reflectance at grazing incidence in Schlick's formula.
inline float schlick_share(float cosine) {
  const float m = 1 - cosine, m_sq = m * m;
  return m_sq * m_sq * m;
}

/// Reflectance of a surface that reflects `f0` at normal and `f90` at grazing incidence (Schlick 1994, Eq. 15, where
/// f90 is 1).
inline Rgb schlick_fresnel(const Rgb& f0, float cosine, const Rgb& f90 = Rgb(1)) {
  return f0 + (f90 - f0) * schlick_share(cosine);
}

/// A metal's reflectance, per colour: Schlick's, bent down to `tint` times it at 82 degrees, where metals dip before
/// they rise to 1 ([KHE21], "F82-tint"). Never negative.
inline float tinted_metal_fresnel(float f0, float tint, float cosine) {
  constexpr float kShare = 0.46266436f, kBottom = 0.056652779f;  // (1 - c)^5 and c (1 - c)^6 at c = 1 / 7
  const float share = schlick_share(cosine);
  const float dip = cosine * share * (1 - cosine) / kBottom * (1 - tint);
  return std::max(0.0f, f0 + (1 - f0) * share - dip * (f0 + (1 - f0) * kShare));
}

}  // namespace velour
