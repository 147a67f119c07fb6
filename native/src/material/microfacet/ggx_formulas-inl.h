// GGX and Fresnel formulas. Included inside a namespace: by ggx.h for scalars, and by sources that Highway compiles for
// vectors. `W` is a direction of either (Vec3, LanesVec3), `T` a number.

/// |v|^2 in the space where the microsurface is a sphere, times alpha.x alpha.y: D = alpha.x alpha.y / (pi
/// spread(h)^2). Homogeneous of degree 2, so a half vector need not be normalized (see ggx_mixture_pdf). Uses sines,
/// since 1 - cosine squared loses a sharp peak to rounding.
template <class W = Vec3>
inline auto ggx_spread(const W& v, const Vec2& alpha) {
  const float ratio = alpha.y / alpha.x, inverse = alpha.x / alpha.y;
  return v.x * v.x * ratio + v.y * v.y * inverse + alpha.x * alpha.y * (v.z * v.z);
}

/// Density D of microfacet normals per solid angle of h, so that the integral of D h.z is 1.
template <class W = Vec3>
inline auto ggx_distribution(const W& h, const Vec2& alpha) {
  const auto spread = ggx_spread(h, alpha);
  return select(h.z > 0.0f, alpha.x * alpha.y / (kPi * spread * spread), 0.0f);
}

/// w.z (1 + 2 Lambda(w)): the square root that all of Smith's masking terms share.
template <class W = Vec3>
inline auto ggx_projected_length(const W& w, const Vec2& alpha) {
  const auto x = alpha.x * w.x, y = alpha.y * w.y;
  return square_root(w.z * w.z + x * x + y * y);
}

/// G2 / (4 wl.z wv.z), in 1/sr with D: the specular BRDF without its Fresnel term. Both directions above the horizon.
template <class W = Vec3>
inline auto ggx_brdf_without_fresnel(const Vec3& wv, const W& wl, const W& h, const Vec2& alpha) {
  const auto bottom = wl.z * ggx_projected_length(wv, alpha) + wv.z * ggx_projected_length(wl, alpha);
  return 0.5f * ggx_distribution(h, alpha) / bottom;
}

/// ggx_brdf_without_fresnel() with independent shadowing of both directions, G1 G1 in place of G2 [WMLT07, Eq. 23].
template <class W = Vec3>
inline auto ggx_brdf_of_independent_shadows(const Vec3& wv, const W& wl, const W& h, const Vec2& alpha) {
  return ggx_distribution(h, alpha) /
         ((wv.z + ggx_projected_length(wv, alpha)) * (wl.z + ggx_projected_length(wl, alpha)));
}

/// Half vector of unit directions; 0 for opposite ones, which no facet mirrors.
template <class W = Vec3>
inline W half_vector(const Vec3& wv, const W& wl) {
  const auto x = wl.x + wv.x, y = wl.y + wv.y, z = wl.z + wv.z;
  const auto length_sq = x * x + y * y + z * z;
  const auto scale = select(length_sq > 0.0f, 1.0f / square_root(length_sq), 0.0f);
  return {x * scale, y * scale, z * scale};
}

/// View-dependent factor of pdf_ggx_reflection(), which is this times 1 / ggx_spread(h)^2.
inline float pdf_ggx_reflection_scale(const Vec3& wv, const Vec2& alpha) {
  return 0.5f * alpha.x * alpha.y / (kPi * (wv.z + ggx_projected_length(wv, alpha)));
}

/// Density of sampling a visible normal h, per solid angle of the mirrored wl: G1 D / (4 wv.z).
template <class W = Vec3>
inline auto pdf_ggx_reflection(const Vec3& wv, const W& h, const Vec2& alpha) {
  const auto spread = ggx_spread(h, alpha);
  return select(h.z > 0.0f, pdf_ggx_reflection_scale(wv, alpha) / (spread * spread), 0.0f);
}

/// Unpolarized reflectance of a smooth dielectric, `cosine` in [0, 1]. `eta` > 0: its index relative to the medium that
/// the light comes from; below 1, light is reflected totally beyond the critical angle.
template <class T>
inline T dielectric_fresnel(T cosine, float eta) {
  if (eta == 1) return 0.0f;
  const T inside_sq = eta * eta - 1 + cosine * cosine;
  const T inside = square_root(larger(inside_sq, 0.0f));  // eta times the cosine of the refracted ray
  const T parallel = (eta * eta * cosine - inside) / (eta * eta * cosine + inside);
  const T perpendicular = (cosine - inside) / (cosine + inside);
  const T partly = 0.5f * (parallel * parallel + perpendicular * perpendicular);
  return eta > 1 ? partly : select(inside_sq > 0.0f, partly, T(1.0f));
}

/// Density D of the normals of a clear coat before Blender 4.0 ("GTR1" of [Bur12, App. B]), so that the integral of D
/// h.z is 1. `alpha` < 1.
template <class W = Vec3>
inline auto gtr1_distribution(const W& h, float alpha) {
  const float alpha_sq = alpha * alpha, scale = (alpha_sq - 1) / (kPi * std::log(alpha_sq));
  return scale / (h.x * h.x + h.y * h.y + alpha_sq * (h.z * h.z));
}

/// (1 - cosine)^5: weight of the grazing reflectance in Schlick's formula.
template <class T>
inline T schlick_share(T cosine) {
  const T m = 1.0f - cosine, m_sq = m * m;
  return m_sq * m_sq * m;
}

/// Reflectance of a metal, per color channel: Schlick's, scaled by `tint` at 82 degrees, where metals dip before they
/// rise to 1 ([KHE21], "F82-tint"). Never negative.
template <class T>
inline T tinted_metal_fresnel(float f0, float tint, T cosine) {
  constexpr float kShare = 0.46266436f, kBottom = 0.056652779f;  // (1 - c)^5 and c (1 - c)^6 at c = 1 / 7
  const T share = schlick_share(cosine);
  const float depth = (1 - tint) / kBottom * (f0 + (1 - f0) * kShare);
  return larger(0.0f, f0 + (1 - f0) * share - cosine * share * (1.0f - cosine) * depth);
}

/// Cosine-weighted mean of tinted_metal_fresnel() over the hemisphere, 2 int F mu dmu, in closed form.
inline float mean_tinted_metal_fresnel(float f0, float tint) {
  constexpr float kShare = 0.46266436f, kBottom = 0.056652779f;  // as above
  const float depth = (1 - tint) / kBottom * (f0 + (1 - f0) * kShare);
  return larger(0.0f, f0 + (1 - f0) * (1 / 21.0f) - depth * (1 / 126.0f));
}
