// Formulas of the GGX distribution and of Fresnel's reflectance. Included inside a namespace: by ggx.h for one number,
// and by sources that Highway compiles, for several side by side. `W` is a direction of either (Vec3, LanesVec3), `T` a
// number.

/// |v|^2 in the space where the microsurface is a sphere, times alpha.x alpha.y: D = alpha.x alpha.y / (pi
/// spread(h)^2). Homogeneous of degree 2, so that a half vector need not be normalised: see pdf_ggx_reflection. In
/// sines, not in 1 - cosine squared, which loses a sharp peak.
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

/// The same as if both directions were shadowed independently, G1 G1 in the place of G2 [WMLT07, Eq. 23].
template <class W = Vec3>
inline auto ggx_brdf_of_independent_shadows(const Vec3& wv, const W& wl, const W& h, const Vec2& alpha) {
  return ggx_distribution(h, alpha) /
         ((wv.z + ggx_projected_length(wv, alpha)) * (wl.z + ggx_projected_length(wl, alpha)));
}

/// Of unit directions; 0 for opposed ones: no facet mirrors them.
template <class W = Vec3>
inline W half_vector(const Vec3& wv, const W& wl) {
  const auto x = wl.x + wv.x, y = wl.y + wv.y, z = wl.z + wv.z;
  const auto length_sq = x * x + y * y + z * z;
  const auto scale = select(length_sq > 0.0f, 1.0f / square_root(length_sq), 0.0f);
  return {x * scale, y * scale, z * scale};
}

/// The part of pdf_ggx_reflection that the view alone decides: times 1 / ggx_spread(h)^2, it is that density.
inline float pdf_ggx_reflection_scale(const Vec3& wv, const Vec2& alpha) {
  return 0.5f * alpha.x * alpha.y / (kPi * (wv.z + ggx_projected_length(wv, alpha)));
}

/// Density, per solid angle of the mirrored wl, of a visible normal h: G1 D / (4 wv.z).
template <class W = Vec3>
inline auto pdf_ggx_reflection(const Vec3& wv, const W& h, const Vec2& alpha) {
  const auto spread = ggx_spread(h, alpha);
  return select(h.z > 0.0f, pdf_ggx_reflection_scale(wv, alpha) / (spread * spread), 0.0f);
}

/// Unpolarised reflectance of a smooth dielectric of relative index `eta` >= 1 from outside, `cosine` in [0, 1].
template <class T>
inline T dielectric_fresnel(T cosine, float eta) {
  if (eta <= 1) return 0.0f;
  const T inside = square_root(eta * eta - 1 + cosine * cosine);  // eta times the cosine of the refracted ray
  const T parallel = (eta * eta * cosine - inside) / (eta * eta * cosine + inside);
  const T perpendicular = (cosine - inside) / (cosine + inside);
  return 0.5f * (parallel * parallel + perpendicular * perpendicular);
}

/// (1 - cosine)^5: the share of the reflectance at grazing incidence in Schlick's formula.
template <class T>
inline T schlick_share(T cosine) {
  const T m = 1.0f - cosine, m_sq = m * m;
  return m_sq * m_sq * m;
}

/// A metal's reflectance, per colour: Schlick's, bent down to `tint` times it at 82 degrees, where metals dip before
/// they rise to 1 ([KHE21], "F82-tint"). Never negative.
template <class T>
inline T tinted_metal_fresnel(float f0, float tint, T cosine) {
  constexpr float kShare = 0.46266436f, kBottom = 0.056652779f;  // (1 - c)^5 and c (1 - c)^6 at c = 1 / 7
  const T share = schlick_share(cosine);
  const float depth = (1 - tint) / kBottom * (f0 + (1 - f0) * kShare);
  return larger(0.0f, f0 + (1 - f0) * share - cosine * share * (1.0f - cosine) * depth);
}

/// Its mean over a hemisphere of light, 2 int F mu dmu, as the polynomial that it is.
inline float mean_tinted_metal_fresnel(float f0, float tint) {
  constexpr float kShare = 0.46266436f, kBottom = 0.056652779f;  // as above
  const float depth = (1 - tint) / kBottom * (f0 + (1 - f0) * kShare);
  return larger(0.0f, f0 + (1 - f0) * (1 / 21.0f) - depth * (1 / 126.0f));
}
