// Material of a BTF with an open structure, on a surface whose rays intersect the structure's silhouette themselves.
#pragma once

#include <memory>

#include "material/material.h"

namespace velour {

/// f of the solid part, from a BTF whose values average solid and empty parts. Texels beyond a silhouette hold light of
/// the structure inside; it is folded back over the silhouette, so that rays that hit the structure gather exactly all
/// of it.
class HoledBtfMaterial final : public Material {
 public:
  explicit HoledBtfMaterial(std::shared_ptr<const Material> btf) : btf_(std::move(btf)) {}

  void prepare(const Vec3& wv, const SurfaceSite& site, PreparedBrdf& point) const override {
    btf_->prepare(wv, site, point);
    point.folded = site.beyond_outline != Vec2(0.0f);
    if (!point.folded) return;
    if (!point.beyond) point.beyond = std::make_unique<PreparedBrdf>();
    point.beyond->value_only = true;
    SurfaceSite beyond = site;
    beyond.uv += site.beyond_outline;
    btf_->prepare(wv, beyond, *point.beyond);
  }

  void eval(const PreparedBrdf& point, const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    if (point.folded) btf_->eval(*point.beyond, wl, f, pdf);
    RgbBatch inside;
    btf_->eval(point, wl, inside, pdf);
    for (int i = 0; i < wl.count; ++i) f.set(i, inside.get(i) + (point.folded ? f.get(i) : Rgb(0.0f)));
  }
  Reflection eval_one(const PreparedBrdf& point, const Vec3& wl) const override {
    Reflection sum = btf_->eval_one(point, wl);
    if (point.folded) sum.f += btf_->eval_one(*point.beyond, wl).f;
    return sum;
  }

  void sample(const PreparedBrdf& point, std::span<const Vec2> u, DirectionBatch& wl) const override {
    btf_->sample(point, u, wl);
  }
  Vec3 sample_one(const PreparedBrdf& point, const Vec2& u) const override { return btf_->sample_one(point, u); }
  bool proposal_lobes(const PreparedBrdf& point, ProposalLobes& lobes) const override {
    return btf_->proposal_lobes(point, lobes);
  }

  bool varies() const override { return true; }
  bool transmits() const override { return btf_->transmits(); }
  Vec2 texels() const override { return btf_->texels(); }
  bool isotropic() const override { return btf_->isotropic(); }

 private:
  std::shared_ptr<const Material> btf_;
};

}  // namespace velour
