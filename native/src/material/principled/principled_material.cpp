#include "material/principled/principled_material.h"

#include <algorithm>

#include "material/microfacet/ggx.h"
#include "math/sphere/warp.h"

namespace velour {
namespace {

class PreparedPrincipled final : public PreparedBrdf {
 public:
  PreparedPrincipled(const PrincipledParameters& parameters, const Vec3& wv, const LobeFilter& filter)
      : wv_(wv), point_(parameters, wv, filter) {}

  void eval(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    eval_principled(point_, wv_, wl, f, pdf);
  }

  void sample(std::span<const Vec2> u, DirectionBatch& wl) const override {
    wl.fill(u, [&](const Vec2& v) { return draw(v); });
  }

  float diffuse_share(const Vec3& wl, float pdf) const override {
    return std::clamp(point_.diffuse_end * wl.z / (kPi * pdf), 0.0f, 1.0f);
  }

 private:
  Vec3 draw(const Vec2& u) const {
    const float diffuse = point_.diffuse_end, end = point_.specular_end;
    if (u.x < diffuse) return sample_cosine_hemisphere({u.x / diffuse, u.y});
    const bool coat = u.x >= end;
    const float first = coat ? end : diffuse, last = coat ? 1 : end;
    const float rest = std::min((u.x - first) / (last - first), 1 - 0x1p-24f);
    const Vec3 h = sample_ggx_visible_normal(wv_, coat ? point_.coat_alpha : point_.alpha, {rest, u.y});
    return 2 * glm::dot(wv_, h) * h - wv_;
  }

  Vec3 wv_;
  PrincipledPoint point_;
};

}  // namespace

PrincipledMaterial::PrincipledMaterial(const PrincipledParameters& parameters, const PrincipledTextures& textures,
                                       float alpha)
    : parameters_(parameters), textures_(textures), alpha_(alpha) {}

const PreparedBrdf* PrincipledMaterial::prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                                                ScratchArena& arena) const {
  if (!textures_.varies()) return arena.make<PreparedPrincipled>(parameters_, wv, options.filter);
  PrincipledParameters p = parameters_;
  p.base_color = textures_.base_color.at(site, p.base_color);
  p.metallic = textures_.metallic.at(site, p.metallic);
  p.roughness = textures_.roughness.at(site, p.roughness);
  return arena.make<PreparedPrincipled>(p, wv, options.filter);
}

float PrincipledMaterial::alpha(const SurfaceSite& site) const {
  return std::clamp(textures_.alpha.at(site, alpha_), 0.0f, 1.0f);
}

std::shared_ptr<const Material> make_principled_material(const PrincipledParameters& parameters,
                                                         const PrincipledTextures& textures, float alpha) {
  return std::make_shared<PrincipledMaterial>(parameters, textures, alpha);
}

}  // namespace velour
