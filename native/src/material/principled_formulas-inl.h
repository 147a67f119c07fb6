// Principled materials as a formula. Included inside a namespace, after ggx_formulas-inl.h and as that is: by
// principled_lobes.cpp for one direction, by principled_sampling.cpp for several side by side.

/// By metal and dielectric with their `lobe`, G2 D / (4 cos cos).
template <class T>
inline PrincipledParts<T> principled_reflected(const PrincipledLobes::Layers& layers, T lobe, T cosine) {
  const T rise = (dielectric_fresnel(cosine, layers.eta) - layers.f0) * (1 / (1 - layers.f0));
  const T dielectric = (1 - layers.metallic) * lobe;
  return {dielectric * rise, dielectric * layers.f0 * (1.0f - rise), 0.0f, layers.metallic * lobe, cosine};
}

template <class W>
inline auto principled_parts(const PrincipledLobes::Layers& layers, const PrincipledLobes::View& view, const W& wl,
                             const W& h) {
  using T = decltype(dot(view.wv, h));
  const T cosine = smaller(larger(dot(view.wv, h), 0.0f), 1.0f);
  T lobe = ggx_brdf_without_fresnel(view.wv, wl, h, layers.alpha), coat = 0.0f;
  if (layers.coat > 0) {
    lobe = lobe * smaller(view.through, 1.0f - layers.coat * albedo_at(*layers.coat_albedo, wl.z));
    coat = layers.coat * ggx_brdf_without_fresnel(view.wv, wl, h, layers.coat_alpha) *
           dielectric_fresnel(cosine, kCoatIndex);
  }
  PrincipledParts<T> out = principled_reflected(layers, lobe, cosine);
  out.fixed = out.fixed + coat;
  out.diffuse = view.diffuse_scale * (1.0f - albedo_at(*layers.top_albedo, wl.z));
  return out;
}

/// f of one colour.
template <class T>
inline T principled_value(const PrincipledParts<T>& p, float base_color, float specular_tint) {
  return p.fixed + p.dielectric * specular_tint + p.diffuse * base_color +
         p.metal * tinted_metal_fresnel(base_color, specular_tint, p.cosine);
}
