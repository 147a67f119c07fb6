#include "material/principled/principled_material.h"

#include <algorithm>

#include "material/microfacet/ggx.h"
#include "math/sphere/warp.h"

namespace velour {
namespace {

Vec3 draw(const PrincipledPoint& point, const Vec3& wv, const Vec2& u) {
  const float diffuse = point.diffuse_end, end = point.specular_end;
  if (u.x < diffuse) return sample_cosine_hemisphere({u.x / diffuse, u.y});
  const bool coat = u.x >= end;
  const float first = coat ? end : diffuse, last = coat ? 1 : end;
  const float rest = std::min((u.x - first) / (last - first), 1 - 0x1p-24f);
  const Vec3 h = sample_ggx_visible_normal(wv, coat ? point.coat_alpha : point.alpha, {rest, u.y});
  return 2 * glm::dot(wv, h) * h - wv;
}

}  // namespace

PrincipledMaterial::PrincipledMaterial(const PrincipledParameters& parameters, const PrincipledTextures& textures,
                                       float alpha)
    : parameters_(parameters), textures_(textures), alpha_(alpha) {}

void PrincipledMaterial::prepare(const Vec3& wv, const SurfaceSite& site, PreparedBrdf& point) const {
  point.wv = wv;
  if (!textures_.varies()) {
    point.principled = PrincipledPoint(parameters_, wv, point.filter);
    return;
  }
  PrincipledParameters p = parameters_;
  p.base_color = textures_.base_color.at(site, p.base_color);
  p.metallic = textures_.metallic.at(site, p.metallic);
  p.roughness = textures_.roughness.at(site, p.roughness);
  point.principled = PrincipledPoint(p, wv, point.filter);
}

void PrincipledMaterial::eval(const PreparedBrdf& point, const DirectionBatch& wl, RgbBatch& f,
                              ScalarBatch& pdf) const {
  eval_principled(point.principled, point.wv, wl, f, pdf);
}

void PrincipledMaterial::sample(const PreparedBrdf& point, std::span<const Vec2> u, DirectionBatch& wl) const {
  wl.fill(u, [&](const Vec2& v) { return draw(point.principled, point.wv, v); });
}

float PrincipledMaterial::diffuse_share(const PreparedBrdf& point, const Vec3& wl, float pdf) const {
  return std::clamp(point.principled.diffuse_end * wl.z / (kPi * pdf), 0.0f, 1.0f);
}

float PrincipledMaterial::alpha(const SurfaceSite& site) const {
  return std::clamp(textures_.alpha.at(site, alpha_), 0.0f, 1.0f);
}

std::shared_ptr<const Material> make_principled_material(const PrincipledParameters& parameters,
                                                         const PrincipledTextures& textures, float alpha) {
  return std::make_shared<PrincipledMaterial>(parameters, textures, alpha);
}

}  // namespace velour
