#include "material/principled/principled_point.h"

#include <algorithm>
#include <cmath>

#include "material/microfacet/ggx_albedo.h"

namespace velour {

#include "material/principled/principled_formulas-inl.h"

namespace {

/// Blender's scale: specular 0.5 is 4 % at normal incidence, an index of 1.5.
float index_of(float specular) {
  const float root = std::sqrt(std::clamp(0.08f * specular, 0.0f, 0.9f));
  return (1 + root) / (1 - root);
}

/// 2 int F(mu, eta) mu dmu, by a fit [KC17].
float mean_fresnel(float eta) { return (eta - 1) / (4.08567f + 1.00071f * eta); }

float rough_enough(float roughness) { return std::clamp(roughness, kMinRoughness, 1.0f); }

Rgb within_one(const Rgb& color) { return glm::clamp(color, Rgb(0), Rgb(1)); }

Interreflection facets_of_coat(const PrincipledParameters& p, float cosine) {
  return {p.coat_lobe, rough_enough(p.coat_roughness), cosine};
}

float index_of_coat(const PrincipledParameters& p) { return std::max(p.coat_index, 1.0f); }

float weight_of_coat(const PrincipledParameters& p, float cosine) {
  const float eta = index_of_coat(p);
  if (!(p.coat > 0) || eta <= 1) return 0;
  return std::min(p.coat, 1.0f) * facets_of_coat(p, cosine).gain(Rgb(mean_fresnel(eta))).r;
}

/// Share of the light that the coat reflects.
float albedo_of_coat(const PrincipledParameters& p, float cosine) {
  const float eta = index_of_coat(p), normal = dielectric_fresnel(1.0f, eta);
  if (eta <= 1) return 0;
  if (p.coat_lobe != GgxLobe::whole) return dielectric_fresnel(cosine, eta);
  const float risen = ggx_albedo::mean_rise(rough_enough(p.coat_roughness), cosine, eta);
  return facets_of_coat(p, cosine).gain_of_whole(Rgb(mean_fresnel(eta))).r * glm::mix(normal, 1.0f, risen);
}

}  // namespace

Rgb through_coat(const PrincipledParameters& p, float cosine, const LobeFilter& filter) {
  if (!(p.coat > 0)) return Rgb(1);
  const float weight = std::min(p.coat, 1.0f), eta = index_of_coat(p);
  const float depth = 1 / std::sqrt(1 - (1 - cosine * cosine) / (eta * eta));
  const Rgb tint = glm::pow(glm::max(p.coat_tint, Rgb(0)), Rgb(depth));
  const float passing = filter.diffuse_only ? 1 : 1 - weight * albedo_of_coat(p, cosine);
  return passing * glm::mix(Rgb(1), tint, weight);
}

PrincipledPoint::PrincipledPoint(const PrincipledParameters& p, const Vec3& wv, const LobeFilter& filter)
    : base_color(within_one(p.base_color)),
      specular_tint(glm::max(p.specular_tint, Rgb(0))),
      roughness(rough_enough(p.roughness)),
      formula(p.formula),
      lobe(p.lobe) {
  const float cosine = std::min(wv.z, 1.0f), coat_roughness = rough_enough(p.coat_roughness);
  alpha = Vec2(std::max(roughness * roughness, filter.min_alpha));
  coat_alpha = Vec2(std::max(coat_roughness * coat_roughness, filter.min_alpha));
  coat_eta = index_of_coat(p);
  eta = index_of(p.specular);
  f0 = dielectric_fresnel(1.0f, eta);
  view_rise = schlick_share(cosine);
  if (formula == PrincipledFormula::disney) {
    set_disney(p, cosine, filter);
  } else {
    set_layered(p, cosine, filter);
  }
  const auto is_part = [&](PrincipledPart part) { return p.part == PrincipledPart::whole || p.part == part; };
  if (!is_part(PrincipledPart::base)) diffuse = Rgb(0);
  if (!is_part(PrincipledPart::specular) || filter.diffuse_only) at_normal = rise = metal = Rgb(0);
  if (!is_part(PrincipledPart::coat) || filter.diffuse_only) coat = 0;
  set_shares(cosine);
}

Rgb PrincipledPoint::reflectance(float cosine) const {
  Rgb out;
  for (int c = 0; c < 3; ++c) out[c] = principled_reflectance(*this, cosine, principled_rise(*this, cosine), c);
  return out;
}

float PrincipledPoint::mean_rise() const { return std::clamp((mean_fresnel(eta) - f0) / (1 - f0), 0.0f, 1.0f); }

void PrincipledPoint::set_layered(const PrincipledParameters& p, float cosine, const LobeFilter& filter) {
  const float metallic = std::clamp(p.metallic, 0.0f, 1.0f);
  coat = weight_of_coat(p, cosine);
  const Rgb through = through_coat(p, cosine, filter), rest = through * (1 - metallic);
  const Interreflection facets(lobe, roughness, cosine);
  Rgb mean_metal;
  for (int c = 0; c < 3; ++c) mean_metal[c] = mean_tinted_metal_fresnel(base_color[c], metal_tint(c));
  metal = metallic > 0 ? through * metallic * facets.gain(mean_metal) : Rgb(0);
  at_normal = rise = Rgb(0);
  float passing = 1;
  if (eta > 1 && metallic < 1) {
    const Rgb normal = f0 * specular_tint;
    const Rgb mean = glm::mix(normal, Rgb(1), mean_rise()), weight = rest * facets.gain(mean);
    at_normal = weight * normal;
    rise = weight * (1.0f - normal);
    const Rgb albedo =
        facets.gain_of_whole(mean) * glm::mix(normal, Rgb(1), ggx_albedo::mean_rise(roughness, cosine, eta));
    if (!filter.diffuse_only) passing = std::clamp(1 - std::max({albedo.r, albedo.g, albedo.b}), 0.0f, 1.0f);
  }
  diffuse = base_color * (rest * passing / kPi);
}

void PrincipledPoint::set_disney(const PrincipledParameters& p, float cosine, const LobeFilter& filter) {
  const float metallic = std::clamp(p.metallic, 0.0f, 1.0f);
  coat = 0;
  metal = Rgb(0);
  const float normal = 0.08f * std::max(p.specular, 0.0f);
  const Rgb color = within_one(glm::mix(normal * specular_tint, base_color, metallic));
  // Cycles simulates the random walk between facets with the filtered roughness.
  const float walked = std::max(roughness, std::sqrt(filter.min_alpha));
  const Rgb gain = Interreflection(lobe, walked, cosine).gain(glm::mix(color, Rgb(1), mean_rise()));
  at_normal = gain * color;
  rise = gain * (1.0f - color);
  diffuse = base_color * ((1 - metallic) / kPi);
}

/// The shares affect only the noise, so a metal's albedo is approximated by that of a smooth one.
void PrincipledPoint::set_shares(float cosine) {
  const float albedo = ggx_albedo::of_white(roughness, cosine);
  const float gained = eta > 1 ? ggx_albedo::mean_rise(roughness, cosine, eta) : 0.0f;
  const Rgb reflectance = at_normal + rise * gained + metal * schlick_fresnel(base_color, cosine);
  const float of_base = kPi * luminance(diffuse), of_lobe = albedo * luminance(reflectance);
  const float of_coat = coat > 0 ? coat * dielectric_fresnel(cosine, coat_eta) : 0.0f;
  const float total = of_base + of_lobe + of_coat;
  if (!(total > 0)) return;
  diffuse_end = of_base / total;
  specular_end = of_coat > 0 ? (of_base + of_lobe) / total : 1;
}

}  // namespace velour
