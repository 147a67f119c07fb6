#include "material/principled/principled_material.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "material/microfacet/ggx.h"
#include "math/sphere/warp.h"

namespace velour {
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

PrincipledMaterial::PrincipledMaterial(const PrincipledParameters& parameters, const PrincipledTextures& textures,
                                       float alpha)
    : parameters_(parameters), textures_(textures), alpha_(alpha) {}

const PreparedBrdf* PrincipledMaterial::prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                                                ScratchArena& arena) const {
  PrincipledParameters p = parameters_;
  if (textures_.varies()) {
    p.base_color = textures_.base_color.at(site, p.base_color);
    p.metallic = textures_.metallic.at(site, p.metallic);
    p.roughness = textures_.roughness.at(site, p.roughness);
  }
  if (!has_glass(p)) return arena.make<PreparedPrincipled>(p, wv, options.filter);
  return arena.make<PreparedPrincipled>(p, wv, GlassLobe(glass_of(p), wv, site.back, options), options.filter);
}

bool PrincipledMaterial::transmits() const {
  PrincipledParameters p = parameters_;
  if (textures_.metallic.given()) p.metallic = 0;
  return has_glass(p);
}

float PrincipledMaterial::alpha(const SurfaceSite& site) const {
  return std::clamp(textures_.alpha.at(site, alpha_), 0.0f, 1.0f);
}

std::shared_ptr<const Material> make_principled_material(const PrincipledParameters& parameters,
                                                         const PrincipledTextures& textures, float alpha) {
  return std::make_shared<PrincipledMaterial>(parameters, textures, alpha);
}

}  // namespace velour
