// The GGX microfacet distribution with Smith's height-correlated masking: Heitz 2014, JCGT 3(2), and sampling of the
// visible normals: Heitz 2018, JCGT 7(4). Directions are unit, in the local frame; `alpha` > 0 is the slope roughness
// along x and along y.
#pragma once

#include <algorithm>

#include "math/sphere/number_math.h"
#include "math/sphere/vec.h"

namespace velour {

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

}  // namespace velour
