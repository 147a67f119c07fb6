#include "material/microfacet/glass_lobe.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "material/microfacet/ggx.h"
#include "math/sphere/frame.h"
#include "math/sphere/random.h"

namespace velour {
namespace {

constexpr float kMinBend = 1e-4f;       // of the index from 1, below which Cycles refracts without scattering
constexpr float kMinRefracted = 1e-4f;  // of the refracted part where the surface reflects totally, as in Cycles

float mean(const Rgb& c) { return (c.r + c.g + c.b) / 3; }

/// w.z (1 + 2 Lambda(w)) over w.z.
float stretch(const Vec3& w, const Vec2& alpha) { return ggx_projected_length(w, alpha) / std::abs(w.z); }

Vec2 slope_of(float roughness, const LobeFilter& filter) {
  const float r = std::clamp(roughness, 0.0f, 1.0f);
  return Vec2(std::max(r * r, filter.min_alpha));
}

}  // namespace

GlassLobe::GlassLobe(const GlassParameters& parameters, const Vec3& wv, bool back, const PrepareOptions& options)
    : wv_(wv), p_(parameters), as_cycles_(options.of_path && !options.facets_only) {
  const float index = std::max(p_.index, 1e-5f);
  eta_ = back ? 1 / index : index;
  if (options.filter.diffuse_only) p_.reflected = Rgb(0.0f);
  alpha_ = slope_of(p_.roughness, options.filter);
  const bool is_one = p_.fresnel == GlassFresnel::facets;
  refraction_alpha_ = is_one ? alpha_ : slope_of(p_.refraction_roughness, options.filter);
  const bool bends = std::abs(eta_ - 1) >= kMinBend;
  mirrors_ = options.of_path && alpha_.x < kMinGgxAlpha;
  passes_straight_ = options.of_path && (refraction_alpha_.x < kMinGgxAlpha || !bends);
  if (!options.of_path && !bends) eta_ = eta_ < 1 ? 1 - kMinBend : 1 + kMinBend;
  alpha_ = glm::max(alpha_, Vec2(kMinGgxAlpha));
  refraction_alpha_ = glm::max(refraction_alpha_, Vec2(kMinGgxAlpha));
  f0_ = dielectric_fresnel(1.0f, eta_);
  surface_ = dielectric_fresnel(std::min(wv.z, 1.0f), eta_);
  if (!p_.only_refracts && p_.lobe == GgxLobe::whole && !mirrors_) {
    const float roughness = std::clamp(p_.roughness, 0.0f, 1.0f);  // the filter does not change brightness
    gain_ = Interreflection::of_glass(p_.lobe, roughness, wv.z, eta_).gain(glm::clamp(p_.refracted, Rgb(0), Rgb(1)));
  }
  const Divided light = divide(std::min(wv.z, 1.0f));
  share_ = light.share;
  const bool scatters = !(mirrors_ || p_.only_refracts) || !passes_straight_;
  albedo_ = (mirrors_ ? 0.0f : luminance(light.reflected)) + (passes_straight_ ? 0.0f : luminance(light.refracted));
  albedo_ = scatters ? std::max(albedo_, 1e-3f) : 0.0f;
}

GlassLobe::Divided GlassLobe::divide(float cosine) const {
  const float facet = dielectric_fresnel(cosine, eta_);
  const float rise = (facet - f0_) / std::max(1 - f0_, 1e-6f);
  Divided light{};
  if (p_.only_refracts) {
    light.refracted = p_.fresnel == GlassFresnel::facets && facet >= 1 ? Rgb(0.0f) : p_.refracted;
  } else if (p_.fresnel == GlassFresnel::facets) {
    const Rgb normal = glm::clamp(f0_ * p_.at_normal, Rgb(0), Rgb(1));
    const Rgb reflectance = glm::mix(normal, Rgb(1), std::clamp(rise, 0.0f, 1.0f));
    light.reflected = gain_ * p_.reflected * reflectance;
    light.refracted = gain_ * p_.refracted * (1.0f - reflectance);
  } else {
    light.reflected = gain_ * p_.reflected * (surface_ * glm::mix(p_.at_normal, Rgb(1), rise));
    light.refracted = gain_ * p_.refracted * std::max(1 - surface_, kMinRefracted);
  }
  const float reflected = mirrors_ ? 0.0f : mean(light.reflected);
  const float refracted = passes_straight_ ? 0.0f : mean(light.refracted);
  light.share = reflected > 0 ? reflected / (reflected + refracted) : 0.0f;
  if (p_.fresnel == GlassFresnel::surface && share_ >= 0) light.share = share_;
  return light;
}

PreparedBrdf::Reflection GlassLobe::reflection(const Vec3& wl) const {
  if (mirrors_ || p_.only_refracts) return {Rgb(0.0f), 0.0f};
  const Vec3 h = half_vector(wv_, wl);
  const Divided light = divide(std::clamp(glm::dot(wv_, h), 0.0f, 1.0f));
  const float lobe = p_.lobe == GgxLobe::separable ? ggx_brdf_of_independent_shadows(wv_, wl, h, alpha_)
                                                   : ggx_brdf_without_fresnel(wv_, wl, h, alpha_);
  return {light.reflected * lobe, light.share * pdf_ggx_reflection(wv_, h, alpha_)};
}

PreparedBrdf::Reflection GlassLobe::refraction(const Vec3& wl) const {
  const PreparedBrdf::Reflection none{Rgb(0.0f), 0.0f};
  if (passes_straight_) return none;
  const Vec3 sum = -(eta_ * wl + wv_);
  const float length_sq = glm::dot(sum, sum);
  if (!(length_sq > 0)) return none;
  const Vec3 h = sum / std::sqrt(length_sq);
  const float view = glm::dot(h, wv_), light_cosine = glm::dot(h, wl);
  const float side = eta_ > 1 ? 1.0f : -1.0f;
  const bool is_facet = side * h.z > 0 && side * view > 0 && side * light_cosine < 0;
  if (!is_facet && !as_cycles_) return none;
  const Divided light = divide(std::min(std::abs(view), 1.0f));
  if (!is_facet && light.refracted == Rgb(0.0f)) return none;
  const Vec2& alpha = refraction_alpha_;
  const float spread = ggx_spread(h, alpha), a = stretch(wv_, alpha), b = stretch(wl, alpha);
  const float facets =
      alpha.x * alpha.y / (kPi * spread * spread) / wv_.z * (eta_ * eta_ / length_sq) * std::abs(view * light_cosine);
  const float first = 2 / (1 + a), both = p_.lobe == GgxLobe::separable ? first * 2 / (1 + b) : 2 / (a + b);
  return {light.refracted * (facets * both / -wl.z), (1 - light.share) * facets * first};
}

Vec3 GlassLobe::refracted(const Vec3& normal, float cosine) const {
  const float inside_sq = eta_ * eta_ - 1 + cosine * cosine;
  if (inside_sq <= 0) return Vec3(0.0f);
  return ((cosine - std::sqrt(inside_sq)) * normal - wv_) / eta_;
}

Vec3 GlassLobe::sample(const Vec2& u) const {
  // A third number. The low bits of one of the two would not do: in a scrambled sequence they depend on the index of
  // the point as those of other sequences do.
  const uint64_t bits = (uint64_t{std::bit_cast<uint32_t>(u.x)} << 32) + std::bit_cast<uint32_t>(u.y);
  const float choice = unit_float(mix64(bits));
  // Roughnesses differ only where the share is the same for all facets.
  const bool is_refracted = p_.fresnel == GlassFresnel::surface && choice >= share_;
  const Vec3 h = sample_ggx_visible_normal(wv_, is_refracted ? refraction_alpha_ : alpha_, u);
  const float cosine = glm::dot(wv_, h);
  const bool is_mirrored = choice < divide(std::clamp(cosine, 0.0f, 1.0f)).share;
  const Vec3 wl = is_mirrored ? 2 * cosine * h - wv_ : refracted(h, cosine);
  return is_mirrored ? (wl.z > 0 ? wl : Vec3(0.0f)) : (wl.z < 0 ? wl : Vec3(0.0f));
}

void GlassLobe::add_deltas(const Rgb& weight, DeltaLobes& lobes) const {
  const float cosine = std::min(wv_.z, 1.0f);
  const Divided light = divide(cosine);
  if (mirrors_ && !p_.only_refracts) lobes.add(reflected(wv_), weight * light.reflected);
  if (!passes_straight_) return;
  const Vec3 wl = refracted({0, 0, 1}, cosine);
  if (wl.z < 0) lobes.add(wl, weight * light.refracted);
}

}  // namespace velour
