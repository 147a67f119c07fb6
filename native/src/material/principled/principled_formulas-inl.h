// Formulas of the Principled BSDF. Included inside a namespace, after ggx_formulas-inl.h: by principled_material.cpp
// for scalars, and by sources that Highway compiles for vectors.

/// Factor of point.diffuse: 1 except in Disney's formula [Bur12, Sec. 5.3].
template <class W>
inline auto principled_base(const PrincipledPoint& point, const Vec3& wv, const W& wl) {
  using T = decltype(dot(wv, wl));
  if (point.formula != PrincipledFormula::disney) return T(1.0f);
  const T light_rise = schlick_share(smaller(larger(wl.z, 0.0f), 1.0f));
  const T retro = point.roughness * (dot(wv, wl) + 1.0f);  // 2 roughness cos^2 of half the angle between wv and wl
  return (1 - 0.5f * point.view_rise) * (1.0f - 0.5f * light_rise) +
         retro * (light_rise + point.view_rise + light_rise * point.view_rise * (retro - 1.0f));
}

/// (F - F0) / (1 - F0) of the dielectric at the cosine between wv and h, shared by all channels.
template <class T>
inline T principled_rise(const PrincipledPoint& point, T cosine) {
  return (dielectric_fresnel(cosine, point.eta) - point.f0) * (1 / (1 - point.f0));
}

/// Weighted reflectance of the facets in one channel: the factor of the lobe.
template <class T>
inline T principled_reflectance(const PrincipledPoint& point, T cosine, T rise, int c) {
  const T dielectric = point.at_normal[c] + point.rise[c] * rise;
  if (!(point.metal[c] > 0)) return dielectric;
  return dielectric + point.metal[c] * tinted_metal_fresnel(point.base_color[c], point.metal_tint(c), cosine);
}

/// Terms of f shared by all channels.
template <class T>
struct PrincipledParts {
  T base, lobe, rise, coat, sheen, cosine;
};

/// Lobe of the coat: of Disney's clear coat, GTR1 with the masking of an alpha of 0.25.
template <class W>
inline auto principled_coat(const PrincipledPoint& point, const Vec3& wv, const W& wl, const W& h) {
  if (point.formula != PrincipledFormula::disney) return ggx_brdf_without_fresnel(wv, wl, h, point.coat_alpha);
  const Vec2 masked(0.25f);
  return gtr1_distribution(h, point.coat_alpha.x) /
         ((wv.z + ggx_projected_length(wv, masked)) * (wl.z + ggx_projected_length(wl, masked)));
}

/// Density of sampling the coat.
template <class W>
inline auto principled_coat_pdf(const PrincipledPoint& point, const Vec3& wv, const W& h) {
  if (point.formula != PrincipledFormula::disney) return pdf_ggx_reflection(wv, h, point.coat_alpha);
  // A normal that faces away from the view mirrors it below the horizon, where the half vector is its opposite.
  const auto cosine = dot(wv, h);
  const auto density = gtr1_distribution(h, point.coat_alpha.x) * larger(h.z, -1.0f * h.z);
  return select(cosine > 0.0f, density / (4.0f * larger(cosine, 1e-6f)), 0.0f);
}

/// Value of a sheen lobe at a direction above the horizon, which times the cosine is also its density.
template <class W>
inline auto sheen_value(const PrincipledPoint& point, const W& wl) {
  const auto along = point.azimuth.x * wl.x + point.azimuth.y * wl.y;
  const auto across = point.azimuth.x * wl.y - point.azimuth.y * wl.x;
  const float a = point.sheen_lobe.a, b = point.sheen_lobe.b;
  const auto x = a * along + b * wl.z, y = a * across;
  const auto ratio = a / (x * x + y * y + wl.z * wl.z);
  return 1 / kPi * ratio * ratio;
}

template <class W>
inline auto principled_parts(const PrincipledPoint& point, const Vec3& wv, const W& wl, const W& h) {
  using T = decltype(dot(wv, h));
  PrincipledParts<T> parts{principled_base(point, wv, wl),         T(0.0f), T(0.0f), T(0.0f), T(0.0f),
                           smaller(larger(dot(wv, h), 0.0f), 1.0f)};
  parts.lobe = point.lobe == GgxLobe::separable ? ggx_brdf_of_independent_shadows(wv, wl, h, point.alpha)
                                                : ggx_brdf_without_fresnel(wv, wl, h, point.alpha);
  parts.rise = principled_rise(point, parts.cosine);
  if (point.coat > 0) {
    parts.coat = point.coat * principled_coat(point, wv, wl, h) * dielectric_fresnel(parts.cosine, point.coat_eta);
  }
  if (point.sheen != Rgb(0.0f)) {
    parts.sheen = point.formula == PrincipledFormula::disney ? schlick_share(parts.cosine) : sheen_value(point, wl);
  }
  return parts;
}

/// f of one channel.
template <class T>
inline T principled_value(const PrincipledPoint& point, const PrincipledParts<T>& parts, int c) {
  return point.diffuse[c] * parts.base + parts.lobe * principled_reflectance(point, parts.cosine, parts.rise, c) +
         parts.coat + point.sheen[c] * parts.sheen;
}
