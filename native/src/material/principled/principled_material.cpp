#include "material/principled/principled_material.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "material/microfacet/ggx.h"
#include "math/sphere/warp.h"

namespace velour {

#include "material/principled/principled_formulas-inl.h"

namespace {

/// Blender's scale: specular 0.5 is 4 % at normal incidence, an index of 1.5.
float index_of(float specular) {
  const float root = std::sqrt(std::clamp(0.08f * specular, 0.0f, 0.9f));
  return (1 + root) / (1 - root);
}

constexpr float kMinIndex = 1e-5f;  // of glass, as in Cycles
constexpr float kUsualF0 = 0.04f;   // reflectance at normal incidence at index 1.5

/// 2 int F(mu, eta) mu dmu, by a fit [KC17].
float mean_fresnel(float eta) {
  if (eta < 1) return 0.997118f + eta * (0.1014f - eta * (0.965241f + eta * 0.130607f));
  return (eta - 1) / (4.08567f + 1.00071f * eta);
}

float rough_enough(float roughness) { return std::clamp(roughness, kMinRoughness, 1.0f); }

Rgb within_one(const Rgb& color) { return glm::clamp(color, Rgb(0), Rgb(1)); }

Rgb positive(const Rgb& color) { return glm::max(color, Rgb(0)); }

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

SheenLobe sheen_of(const PrincipledParameters& p, float cosine) {
  return {std::clamp(p.sheen_roughness, 1e-3f, 1.0f), std::clamp(cosine, 0.0f, 1.0f)};
}

Rgb through_sheen(const PrincipledParameters& p, float cosine) {
  if (!(p.sheen > 0)) return Rgb(1);
  const Rgb albedo = p.sheen * sheen_of(p, cosine).albedo * positive(p.sheen_tint);
  return Rgb(std::clamp(1 - std::max({albedo.r, albedo.g, albedo.b}), 0.0f, 1.0f));
}

Rgb through_coat(const PrincipledParameters& p, float cosine, const LobeFilter& filter) {
  if (!(p.coat > 0)) return Rgb(1);
  const float weight = std::min(p.coat, 1.0f), eta = index_of_coat(p);
  const float depth = 1 / std::sqrt(1 - (1 - cosine * cosine) / (eta * eta));
  const Rgb tint = glm::pow(positive(p.coat_tint), Rgb(depth));
  const float passing = filter.diffuse_only ? 1 : 1 - weight * albedo_of_coat(p, cosine);
  return passing * glm::mix(Rgb(1), tint, weight);
}

constexpr int kSheenSide = 32;
constexpr int32_t kSheenTable[kSheenSide * kSheenSide * 3] = {
#include "material/principled/sheen_table.inc"
};

constexpr float kMinClearCoatAlpha = 3.2e-4f;  // below it the clear coat is a mirror in Cycles

}  // namespace

SheenLobe::SheenLobe(float roughness, float cosine) {
  constexpr int kEnd = kSheenSide - 1;
  const float x = std::clamp(cosine, 0.0f, 1.0f) * kEnd, y = std::clamp(roughness, 0.0f, 1.0f) * kEnd;
  const int i = std::min(static_cast<int>(x), kEnd - 1), j = std::min(static_cast<int>(y), kEnd - 1);
  const auto entry = [](int row, int column) {
    const int32_t* v = kSheenTable + 3 * (row * kSheenSide + column);
    return 1e-5f * Vec3(v[0], v[1], v[2]);
  };
  const auto in_row = [&](int row) { return glm::mix(entry(row, i), entry(row, i + 1), x - static_cast<float>(i)); };
  const Vec3 found = glm::mix(in_row(j), in_row(j + 1), y - static_cast<float>(j));
  if (found.x >= 1e-5f && found.z >= 1e-5f) a = found.x, b = found.y, albedo = found.z;
}

Rgb through_top(const PrincipledParameters& p, float cosine, float coat_cosine, const LobeFilter& filter) {
  if (p.formula == PrincipledFormula::disney) return Rgb(1);
  return through_sheen(p, cosine) * through_coat(p, coat_cosine, filter);
}

GlassParameters glass_of(const PrincipledParameters& p) {
  GlassParameters glass{
      .roughness = p.roughness, .refraction_roughness = p.roughness, .index = p.index, .lobe = p.lobe};
  if (p.formula == PrincipledFormula::layered) {
    glass.refracted = glm::sqrt(within_one(p.base_color));
    glass.at_normal = positive(p.specular_tint);
    return glass;
  }
  glass.refracted = positive(p.base_color);
  if (p.lobe == GgxLobe::whole) return glass;
  glass.fresnel = GlassFresnel::surface;
  const float added = std::clamp(p.transmission_roughness, 0.0f, 1.0f);
  glass.refraction_roughness = 1 - (1 - std::clamp(p.roughness, 0.0f, 1.0f)) * (1 - added);
  return glass;
}

PrincipledPoint::PrincipledPoint(const PrincipledParameters& p, const Vec3& wv, const LobeFilter& filter,
                                 float glass_albedo)
    : base_color(within_one(p.base_color)),
      specular_tint(positive(p.specular_tint)),
      roughness(rough_enough(p.roughness)),
      formula(p.formula),
      lobe(p.lobe) {
  const float cosine = std::min(wv.z, 1.0f), coat_roughness = rough_enough(p.coat_roughness);
  alpha = Vec2(std::max(roughness * roughness, filter.min_alpha));
  coat_alpha = Vec2(std::max(coat_roughness * coat_roughness, filter.min_alpha));
  coat_eta = index_of_coat(p);
  eta = index_of(p.specular_of_index ? p.specular * dielectric_fresnel(1.0f, p.index) / kUsualF0 : p.specular);
  if (formula == PrincipledFormula::layered && p.index < 1) eta = 1 / eta;
  f0 = dielectric_fresnel(1.0f, eta);
  view_rise = schlick_share(cosine);
  const float across = std::sqrt(wv.x * wv.x + wv.y * wv.y);
  azimuth = across > 0 ? Vec2(wv.x, wv.y) / across : Vec2(1, 0);
  sheen = glass = Rgb(0);
  if (formula == PrincipledFormula::disney) {
    set_disney(p, cosine, filter);
  } else {
    set_layered(p, cosine, filter);
  }
  const auto is_part = [&](PrincipledPart part) { return p.part == PrincipledPart::whole || p.part == part; };
  if (!is_part(PrincipledPart::base)) diffuse = Rgb(0);
  if (!is_part(PrincipledPart::specular) || filter.diffuse_only) at_normal = rise = metal = Rgb(0);
  if (!is_part(PrincipledPart::coat) || filter.diffuse_only) coat = 0;
  const bool is_disney = formula == PrincipledFormula::disney;
  if (!is_part(is_disney ? PrincipledPart::base : PrincipledPart::sheen)) sheen = Rgb(0);
  if (!is_part(PrincipledPart::glass)) glass = Rgb(0);
  set_shares(cosine, glass_albedo);
}

Rgb PrincipledPoint::reflectance(float cosine) const {
  Rgb out;
  for (int c = 0; c < 3; ++c) out[c] = principled_reflectance(*this, cosine, principled_rise(*this, cosine), c);
  return out;
}

float PrincipledPoint::mean_rise() const { return std::clamp((mean_fresnel(eta) - f0) / (1 - f0), 0.0f, 1.0f); }

void PrincipledPoint::set_layered(const PrincipledParameters& p, float cosine, const LobeFilter& filter) {
  const float metallic = std::clamp(p.metallic, 0.0f, 1.0f), transmission = std::clamp(p.transmission, 0.0f, 1.0f);
  if (p.sheen > 0) {
    sheen_lobe = sheen_of(p, cosine);
    sheen = p.sheen * sheen_lobe.albedo * positive(p.sheen_tint);
  }
  coat = weight_of_coat(p, cosine) * through_sheen(p, cosine).r;
  const Rgb through = through_top(p, cosine, cosine, filter), not_metal = through * (1 - metallic);
  const Rgb rest = not_metal * (1 - transmission);
  glass = not_metal * transmission;
  const Interreflection facets(lobe, roughness, cosine);
  Rgb mean_metal;
  for (int c = 0; c < 3; ++c) mean_metal[c] = mean_tinted_metal_fresnel(base_color[c], metal_tint(c));
  metal = metallic > 0 ? through * metallic * facets.gain(mean_metal) : Rgb(0);
  at_normal = rise = Rgb(0);
  float passing = 1;
  if (eta != 1 && metallic < 1) {
    const Rgb normal = f0 * specular_tint;
    const Rgb mean = glm::mix(normal, Rgb(1), mean_rise()), weight = rest * facets.gain(mean);
    at_normal = weight * normal;
    rise = weight * (1.0f - normal);
    const Rgb of_lobe =
        facets.gain_of_whole(mean) * glm::mix(normal, Rgb(1), ggx_albedo::mean_rise(roughness, cosine, eta));
    if (!filter.diffuse_only) passing = std::clamp(1 - std::max({of_lobe.r, of_lobe.g, of_lobe.b}), 0.0f, 1.0f);
  }
  diffuse = positive(p.base_color) * (rest * passing / kPi);
}

void PrincipledPoint::set_disney(const PrincipledParameters& p, float cosine, const LobeFilter& filter) {
  const float metallic = std::clamp(p.metallic, 0.0f, 1.0f), transmission = std::clamp(p.transmission, 0.0f, 1.0f);
  coat = 0.25f * std::clamp(p.coat, 0.0f, 1.0f);
  coat_eta = 1.5f;
  coat_alpha =
      Vec2(std::clamp(p.coat_roughness * p.coat_roughness, std::max(kMinClearCoatAlpha, filter.min_alpha), 0.999f));
  metal = Rgb(0);
  sheen = positive(p.sheen_tint) * (std::max(p.sheen, 0.0f) * (1 - metallic) * (1 - transmission));
  glass = Rgb(transmission * (1 - metallic));
  const float normal = 0.08f * std::max(p.specular, 0.0f);
  const Rgb color = within_one(glm::mix(normal * specular_tint, positive(p.base_color), metallic));
  // Cycles simulates the random walk between facets with the filtered roughness.
  const float walked = std::max(roughness, std::sqrt(filter.min_alpha));
  const Rgb gain = Interreflection(lobe, walked, cosine).gain(glm::mix(color, Rgb(1), mean_rise()));
  const Rgb reflecting = gain * (1 - transmission * (1 - metallic));
  at_normal = reflecting * color;
  rise = reflecting * (1.0f - color);
  diffuse = positive(p.base_color) * ((1 - metallic) * (1 - transmission) / kPi);
}

/// The shares affect only the noise, so a metal's albedo is approximated by that of a smooth one.
void PrincipledPoint::set_shares(float cosine, float glass_albedo) {
  const bool is_disney = formula == PrincipledFormula::disney;
  const float white = ggx_albedo::of_white(roughness, cosine);
  const float gained = eta != 1 ? ggx_albedo::mean_rise(roughness, cosine, eta) : 0.0f;
  const Rgb reflectance = at_normal + rise * gained + metal * schlick_fresnel(base_color, cosine);
  // Disney's sheen follows the base's cosine; it is brightest along the surface.
  const float fuzz = luminance(sheen), along = is_disney ? fuzz * (0.1f + view_rise) : 0.0f;
  const float of_base = kPi * luminance(diffuse) + along, of_lobe = white * luminance(reflectance);
  const float of_coat = coat > 0 ? coat * dielectric_fresnel(cosine, coat_eta) : 0.0f;
  const float of_sheen = is_disney ? 0.0f : fuzz, of_glass = luminance(glass) * glass_albedo;
  albedo = of_base + of_lobe + of_coat + of_sheen + of_glass;
  if (!(albedo > 0)) return;
  diffuse_end = of_base / albedo;
  specular_end = of_coat + of_sheen + of_glass > 0 ? (of_base + of_lobe) / albedo : 1;
  coat_end = of_sheen + of_glass > 0 ? (of_base + of_lobe + of_coat) / albedo : 1;
  sheen_end = of_glass > 0 ? (albedo - of_glass) / albedo : 1;
}

namespace {

/// `u` within [first, last), as a number in [0, 1).
float within(float u, float first, float last) { return std::min((u - first) / (last - first), 1 - 0x1p-24f); }

/// Normal of Disney's clear coat, with density D h.z.
Vec3 sample_gtr1_normal(float alpha, const Vec2& u) {
  const float alpha_sq = alpha * alpha;
  const float sine_sq = (std::pow(alpha_sq, 1 - u.x) - alpha_sq) / (1 - alpha_sq);
  const float sine = std::sqrt(std::clamp(sine_sq, 0.0f, 1.0f)), phi = 2 * kPi * u.y;
  return {sine * std::cos(phi), sine * std::sin(phi), std::sqrt(std::max(1 - sine_sq, 0.0f))};
}

class PreparedPrincipled final : public PreparedBrdf {
 public:
  PreparedPrincipled(const PrincipledParameters& parameters, const Vec3& wv, const LobeFilter& filter)
      : wv_(wv), point_(parameters, wv, filter) {}

  /// With glass.
  PreparedPrincipled(const PrincipledParameters& parameters, const Vec3& wv, const GlassLobe& glass,
                     const LobeFilter& filter)
      : wv_(wv), point_(parameters, wv, filter, glass.albedo()), glass_(glass) {}

  void eval(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    eval_principled(point_, wv_, wl, f, pdf);
    if (!glass_) return;
    for (int i = 0; i < wl.count; ++i) {
      const Reflection glass = glass_->eval(wl.get(i));
      f.set(i, f.get(i) + point_.glass * glass.f);
      pdf.v[i] += (1 - point_.sheen_end) * glass.pdf;
    }
  }

  void sample(std::span<const Vec2> u, DirectionBatch& wl) const override {
    wl.fill(u, [&](const Vec2& v) { return draw(v); });
  }

  void delta_lobes(DeltaLobes& lobes) const override {
    lobes.count = 0;
    lobes.rest = glass_ ? point_.albedo : 1.0f;
    if (glass_) glass_->add_deltas(point_.glass, lobes);
  }

  float diffuse_share(const Vec3& wl, float pdf) const override {
    return std::clamp(point_.diffuse_end * wl.z / (kPi * pdf), 0.0f, 1.0f);
  }

 private:
  Vec3 draw(const Vec2& u) const {
    const PrincipledPoint& p = point_;
    if (u.x < p.diffuse_end) return sample_cosine_hemisphere({u.x / p.diffuse_end, u.y});
    if (u.x < p.specular_end) {
      return mirrored_in(sample_ggx_visible_normal(wv_, p.alpha, {within(u.x, p.diffuse_end, p.specular_end), u.y}));
    }
    if (u.x < p.coat_end) return mirrored_in(coat_normal({within(u.x, p.specular_end, p.coat_end), u.y}));
    if (u.x < p.sheen_end) return sheen_direction({within(u.x, p.coat_end, p.sheen_end), u.y});
    return glass_ ? glass_->sample({within(u.x, p.sheen_end, 1), u.y}) : Vec3(0.0f);
  }

  Vec3 mirrored_in(const Vec3& h) const { return 2 * glm::dot(wv_, h) * h - wv_; }

  Vec3 coat_normal(const Vec2& u) const {
    const bool is_disney = point_.formula == PrincipledFormula::disney;
    return is_disney ? sample_gtr1_normal(point_.coat_alpha.x, u)
                     : sample_ggx_visible_normal(wv_, point_.coat_alpha, u);
  }

  Vec3 sheen_direction(const Vec2& u) const {
    const Vec3 cosine = sample_cosine_hemisphere(u);
    const SheenLobe& lobe = point_.sheen_lobe;
    const Vec3 w = glm::normalize(Vec3(cosine.x - cosine.z * lobe.b, cosine.y, cosine.z * lobe.a));
    const Vec2& to = point_.azimuth;
    return {to.x * w.x - to.y * w.y, to.y * w.x + to.x * w.y, w.z};
  }

  Vec3 wv_;
  PrincipledPoint point_;
  std::optional<GlassLobe> glass_{};
};

bool has_glass(const PrincipledParameters& p) {
  return p.transmission > 0 && p.metallic < 1 && (p.part == PrincipledPart::whole || p.part == PrincipledPart::glass);
}

}  // namespace

PrincipledParameters PrincipledTextures::at(const SurfaceSite& site, PrincipledParameters parameters) const {
  PrincipledParameters& p = parameters;
  const bool is_linear = !metallic.given() && !roughness.given() && numbers.empty() && colors.empty();
  p.base_color = is_linear ? base_color.at(site, p.base_color) : base_color.at_point(site, p.base_color);
  p.metallic = metallic.at_point(site, p.metallic);
  p.roughness = roughness.at_point(site, p.roughness);
  for (const auto& [parameter, slot] : numbers) p.*parameter = slot.at_point(site, p.*parameter);
  for (const auto& [parameter, slot] : colors) p.*parameter = slot.at_point(site, p.*parameter);
  p.index = std::max(p.index, kMinIndex);
  return parameters;
}

PrincipledParameters PrincipledTextures::anywhere(PrincipledParameters parameters) const {
  using P = PrincipledParameters;
  if (metallic.given()) parameters.metallic = 0;
  for (const auto& [parameter, slot] : numbers) {
    if (parameter == &P::coat || parameter == &P::sheen || parameter == &P::transmission) parameters.*parameter = 1;
  }
  return parameters;
}

void PrincipledTextures::remove(float PrincipledParameters::*parameter) {
  std::erase_if(numbers, [&](const PrincipledTexture<float>& texture) { return texture.parameter == parameter; });
}

PrincipledMaterial::PrincipledMaterial(const PrincipledParameters& parameters, const PrincipledTextures& textures,
                                       float alpha)
    : parameters_(parameters), textures_(textures), alpha_(alpha) {}

const PreparedBrdf* PrincipledMaterial::prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                                                ScratchArena& arena) const {
  const PrincipledParameters p = textures_.varies() ? textures_.at(site, parameters_) : parameters_;
  if (!has_glass(p)) return arena.make<PreparedPrincipled>(p, wv, options.filter);
  return arena.make<PreparedPrincipled>(p, wv, GlassLobe(glass_of(p), wv, site.back, options), options.filter);
}

bool PrincipledMaterial::transmits() const { return has_glass(textures_.anywhere(parameters_)); }

float PrincipledMaterial::alpha(const SurfaceSite& site) const {
  return std::clamp(textures_.alpha.at(site, alpha_), 0.0f, 1.0f);
}

std::shared_ptr<const Material> make_principled_material(const PrincipledParameters& parameters,
                                                         const PrincipledTextures& textures, float alpha) {
  return std::make_shared<PrincipledMaterial>(parameters, textures, alpha);
}

}  // namespace velour
