#include "material/principled_point.h"

#include <algorithm>
#include <cmath>

#include "material/ggx_albedo.h"
#include "material/interreflection.h"

namespace velour {

#include "material/principled_formulas-inl.h"

namespace {

/// Blender's scale: specular 0.5 is 4 % at normal incidence, an index of 1.5.
float index_of(float specular) {
  const float root = std::sqrt(std::clamp(0.08f * specular, 0.0f, 0.9f));
  return (1 + root) / (1 - root);
}

float rough_enough(float roughness) { return std::clamp(roughness, kMinRoughness, 1.0f); }

Rgb within_one(const Rgb& color) { return glm::clamp(color, Rgb(0), Rgb(1)); }

}  // namespace

PrincipledPoint::PrincipledPoint(const PrincipledParameters& p, const Vec3& wv)
    : base_color(within_one(p.base_color)),
      specular_tint(within_one(p.specular_tint)),
      roughness(rough_enough(p.roughness)),
      formula(p.formula),
      lobe(p.lobe) {
  const float cosine = std::min(wv.z, 1.0f), coat_roughness = rough_enough(p.coat_roughness);
  alpha = Vec2(roughness * roughness);
  coat_alpha = Vec2(coat_roughness * coat_roughness);
  eta = index_of(p.specular);
  f0 = dielectric_fresnel(1.0f, eta);
  view_rise = schlick_share(cosine);
  if (formula == PrincipledFormula::disney) {
    set_disney(p, cosine);
  } else {
    set_layered(p, cosine);
  }
  if (p.part == PrincipledPart::base) {
    at_normal = rise = metal = Rgb(0);
    coat = 0;
  } else if (p.part == PrincipledPart::specular) {
    diffuse = Rgb(0);
  }
  set_shares(cosine);
}

Rgb PrincipledPoint::reflectance(float cosine) const {
  Rgb out;
  for (int c = 0; c < 3; ++c) out[c] = principled_reflectance(*this, cosine, principled_rise(*this, cosine), c);
  return out;
}

/// By a fit to 2 int F(mu, eta) mu dmu [KC17].
float PrincipledPoint::mean_rise() const {
  const float mean = (eta - 1) / (4.08567f + 1.00071f * eta);
  return std::clamp((mean - f0) / (1 - f0), 0.0f, 1.0f);
}

void PrincipledPoint::set_layered(const PrincipledParameters& p, float cosine) {
  const auto under = [&](float weight, float roughness_above, float index) {
    if (!(weight > 0)) return 1.0f;
    const float normal = dielectric_fresnel(1.0f, index);
    return 1 - weight * (normal + (1 - normal) * ggx_albedo::mean_rise(roughness_above, cosine, index));
  };
  coat = std::clamp(p.coat, 0.0f, 1.0f);
  const float metallic = std::clamp(p.metallic, 0.0f, 1.0f);
  const float through = under(coat, rough_enough(p.coat_roughness), kCoatIndex), rest = through * (1 - metallic);
  const Interreflection facets(lobe, roughness, cosine);
  Rgb mean_metal;
  for (int c = 0; c < 3; ++c) mean_metal[c] = mean_tinted_metal_fresnel(base_color[c], specular_tint[c]);
  metal = metallic > 0 ? through * metallic * facets.gain(mean_metal) : Rgb(0);
  at_normal = rise = Rgb(0);
  float passing = 1;
  if (eta > 1 && rest > 0) {
    const Rgb normal = f0 * specular_tint;
    const Rgb mean = glm::mix(normal, Rgb(1), mean_rise()), weight = rest * facets.gain(mean);
    at_normal = weight * normal;
    rise = weight * (1.0f - normal);
    const Rgb albedo =
        facets.gain_of_whole(mean) * glm::mix(normal, Rgb(1), ggx_albedo::mean_rise(roughness, cosine, eta));
    passing = std::clamp(1 - std::max({albedo.r, albedo.g, albedo.b}), 0.0f, 1.0f);
  }
  diffuse = base_color * (rest * passing / kPi);
}

void PrincipledPoint::set_disney(const PrincipledParameters& p, float cosine) {
  const float metallic = std::clamp(p.metallic, 0.0f, 1.0f);
  coat = 0;
  metal = Rgb(0);
  const float normal = 0.08f * std::max(p.specular, 0.0f);
  const Rgb color = within_one(glm::mix(normal * specular_tint, base_color, metallic));
  const Rgb gain = Interreflection(lobe, roughness, cosine).gain(glm::mix(color, Rgb(1), mean_rise()));
  at_normal = gain * color;
  rise = gain * (1.0f - color);
  diffuse = base_color * ((1 - metallic) / kPi);
}

/// How well they are known decides the noise alone: the albedo of a metal is taken for that of a smooth one.
void PrincipledPoint::set_shares(float cosine) {
  const float albedo = ggx_albedo::of_white(roughness, cosine);
  const float gained = eta > 1 ? ggx_albedo::mean_rise(roughness, cosine, eta) : 0.0f;
  const Rgb reflectance = at_normal + rise * gained + metal * schlick_fresnel(base_color, cosine);
  const float of_base = kPi * luminance(diffuse), of_lobe = albedo * luminance(reflectance);
  const float of_coat = coat > 0 ? coat * dielectric_fresnel(cosine, kCoatIndex) : 0.0f;
  const float total = of_base + of_lobe + of_coat;
  if (!(total > 0)) return;
  diffuse_end = of_base / total;
  specular_end = of_coat > 0 ? (of_base + of_lobe) / total : 1;
}

}  // namespace velour
