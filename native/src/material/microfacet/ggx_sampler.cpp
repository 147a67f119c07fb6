#include "material/microfacet/ggx_sampler.h"

#include <algorithm>
#include <cmath>
#include "material/material.h"
#include "material/microfacet/ggx.h"
#include "math/sphere/random.h"
#include "math/sphere/warp.h"

namespace velour {

namespace {

SpecularAlbedo albedo_along_x(const GgxParameters& p, const Vec2& alpha, float scale) {
  if (scale == 0) return {};
  const float f0 = luminance(p.f0) / scale, f90 = luminance(p.f90) / scale;
  return {alpha, [f0, f90](float cosine) { return f0 + (f90 - f0) * schlick_share(cosine); }};
}

}  // namespace

Rgb ggx_model(const GgxParameters& p, const DirectionPair& w) {
  const Vec3 h = glm::normalize(w.wl + w.wv);
  const Rgb fresnel = schlick_fresnel(p.f0, std::min(glm::dot(w.wv, h), 1.0f), p.f90);
  return p.diffuse / kPi + ggx_brdf_without_fresnel(w, h, p.alpha) * fresnel;
}

GgxSampler::GgxSampler(const GgxParameters& p)
    : alpha_(glm::max(p.alpha, Vec2(kMinGgxAlpha))),
      diffuse_(luminance(p.diffuse)),
      specular_(std::max(luminance(p.f0), luminance(p.f90))),
      along_x_(albedo_along_x(p, alpha_, specular_)),
      along_y_(alpha_.x == alpha_.y ? along_x_ : albedo_along_x(p, {alpha_.y, alpha_.x}, specular_)) {}

/// Exact in the xz and yz planes, approximate between them, which suffices for a sampling probability.
float GgxSampler::specular_albedo(const Vec3& wv) const {
  const float across_sq = wv.x * wv.x + wv.y * wv.y;
  const float x = along_x_.at(wv.z);
  if (alpha_.x == alpha_.y || across_sq == 0) return specular_ * x;
  return specular_ * (x + (along_y_.at(wv.z) - x) * (wv.y * wv.y / across_sq));
}

void GgxSampler::prepare(const Vec3& wv, GgxPoint& point) const {
  const float specular = specular_albedo(wv);
  const float share = diffuse_ + specular > 0 ? diffuse_ / (diffuse_ + specular) : 1;
  point.wv = wv;
  point.cosine_share = kDefensiveShare + (1 - kDefensiveShare) * share;
  point.lobe_scale = (1 - point.cosine_share) * pdf_ggx_reflection_scale(wv, alpha_);
}

Vec3 GgxSampler::sample(const GgxPoint& point, const Vec2& u) const {
  double rest = middle_of_step(u.x);
  const double share = point.cosine_share;
  if (rest < share) {
    const float u_cosine = std::min(static_cast<float>(rest / share), 1 - 0x1p-24f);
    return sample_cosine_hemisphere({u_cosine, u.y});
  }
  rest = (rest - share) / (1 - share);
  const Vec3 h = sample_ggx_visible_normal(point.wv, alpha_, {static_cast<float>(rest), u.y});
  return 2 * glm::dot(point.wv, h) * h - point.wv;
}

void GgxSampler::pdf(const GgxPoint& point, const DirectionBatch& wl, ScalarBatch& pdf) const {
  ggx_mixture_pdf(point, alpha_, wl, pdf);
}

namespace {

float integrate_albedo(const Vec3& wv, const Vec2& alpha, const Fresnel& fresnel) {
  double sum = 0;
  for_visible_facets(wv, alpha, [&](double weight, float cosine, float masking) {
    if (masking > 0) sum += weight * masking * fresnel(cosine);
  });
  return static_cast<float>(std::clamp(sum, 0.0, 1.0));
}

}  // namespace

SpecularAlbedo::SpecularAlbedo(const Vec2& alpha, const Fresnel& fresnel) {
  for (size_t i = 0; i < kEntries; ++i) {
    const float root = static_cast<float>(i) / (kEntries - 1);
    const float cosine = root * root;
    albedo_[i] = integrate_albedo({std::sqrt(1 - cosine * cosine), 0, cosine}, alpha, fresnel);
  }
}

float SpecularAlbedo::at(float cosine) const {
  constexpr size_t kLast = kEntries - 1;
  const float place = std::sqrt(std::clamp(cosine, 0.0f, 1.0f)) * kLast;
  const size_t low = std::min(static_cast<size_t>(place), kLast - 1);
  const float share = place - static_cast<float>(low);
  return (1 - share) * albedo_[low] + share * albedo_[low + 1];
}

}  // namespace velour
