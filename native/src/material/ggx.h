// The GGX microfacet distribution with Smith's height-correlated masking: Heitz 2014, JCGT 3(2), and sampling of the
// visible normals: Heitz 2018, JCGT 7(4). Directions are unit, in the local frame; `alpha` > 0 is the slope roughness.
#pragma once

#include <algorithm>

#include "sphere/vec.h"

namespace velour {

/// Density D of microfacet normals per solid angle of h, so that the integral of D h.z is 1. In sines, not in 1 -
/// cosine squared, which loses a sharp peak.
inline float ggx_distribution(const Vec3& h, float alpha) {
  const float alpha_sq = alpha * alpha;
  const float spread = h.x * h.x + h.y * h.y + alpha_sq * h.z * h.z;
  return h.z > 0 ? alpha_sq / (kPi * spread * spread) : 0;
}

/// w.z (1 + 2 Lambda(w)): the square root that all of Smith's masking terms share.
inline float ggx_projected_length(const Vec3& w, float alpha) {
  return std::sqrt(w.z * w.z + alpha * alpha * (w.x * w.x + w.y * w.y));
}

/// G2 / (4 wl.z wv.z), in 1/sr with D: the specular BRDF without its Fresnel term. Both directions above the horizon.
inline float ggx_brdf_without_fresnel(const DirectionPair& w, const Vec3& h, float alpha) {
  const float bottom = w.wl.z * ggx_projected_length(w.wv, alpha) + w.wv.z * ggx_projected_length(w.wl, alpha);
  return 0.5f * ggx_distribution(h, alpha) / bottom;
}

/// A normal drawn from the normals visible from `wv` (Heitz 2018, Listing 1).
inline Vec3 sample_ggx_visible_normal(const Vec3& wv, float alpha, const Vec2& u) {
  const Vec3 stretched = glm::normalize(Vec3(alpha * wv.x, alpha * wv.y, wv.z));
  const float across_sq = stretched.x * stretched.x + stretched.y * stretched.y;
  const Vec3 t1 = across_sq > 0 ? Vec3(-stretched.y, stretched.x, 0) / std::sqrt(across_sq) : Vec3(1, 0, 0);
  const Vec3 t2 = glm::cross(stretched, t1);
  const float r = std::sqrt(u.x), phi = 2 * kPi * u.y;
  const float p1 = r * std::cos(phi);
  const float s = 0.5f * (1 + stretched.z);
  const float p2 = (1 - s) * std::sqrt(std::max(0.0f, 1 - p1 * p1)) + s * r * std::sin(phi);
  const Vec3 n = p1 * t1 + p2 * t2 + std::sqrt(std::max(0.0f, 1 - p1 * p1 - p2 * p2)) * stretched;
  return glm::normalize(Vec3(alpha * n.x, alpha * n.y, std::max(0.0f, n.z)));
}

/// Density, per solid angle of the mirrored wl, of a visible normal h: G1 D / (4 wv.z).
inline float pdf_ggx_reflection(const Vec3& wv, const Vec3& h, float alpha) {
  return 0.5f * ggx_distribution(h, alpha) / (wv.z + ggx_projected_length(wv, alpha));
}

/// Unpolarised reflectance of a smooth dielectric of relative index `eta` >= 1 from outside, `cosine` in [0, 1].
inline float dielectric_fresnel(float cosine, float eta) {
  if (eta <= 1) return 0;
  const float inside = std::sqrt(eta * eta - 1 + cosine * cosine) / eta;  // cosine of the refracted ray
  const float parallel = (eta * cosine - inside) / (eta * cosine + inside);
  const float perpendicular = (cosine - eta * inside) / (cosine + eta * inside);
  return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

/// Reflectance of a conductor that reflects `f0` at normal incidence (Schlick 1994, Eq. 15).
inline Rgb schlick_fresnel(const Rgb& f0, float cosine) {
  const float m = 1 - cosine, m_sq = m * m;
  return f0 + (Rgb(1) - f0) * (m_sq * m_sq * m);
}

}  // namespace velour
