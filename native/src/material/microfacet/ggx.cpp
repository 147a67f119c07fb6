#include "material/material.h"
#include "material/microfacet/ggx_sampler.h"

namespace velour {

namespace {

class PreparedGgx final : public PreparedBrdf {
 public:
  PreparedGgx(const GgxParameters& parameters, const GgxSampler& sampler, const Vec3& wv)
      : parameters_(parameters), sampler_(sampler), wv_(wv) {
    sampler.prepare(wv, point_);
  }

  void eval(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    for (int i = 0; i < wl.count; ++i) {
      f.set(i, wl.z[i] > 0 ? ggx_model(parameters_, {.wl = wl.get(i), .wv = wv_}) : Rgb(0));
    }
    sampler_.pdf(point_, wl, pdf);
  }

  void sample(std::span<const Vec2> u, DirectionBatch& wl) const override {
    wl.fill(u, [&](const Vec2& v) { return sampler_.sample(point_, v); });
  }

 private:
  const GgxParameters& parameters_;
  const GgxSampler& sampler_;
  Vec3 wv_;
  GgxPoint point_;
};

class GgxMaterial final : public Material {
 public:
  explicit GgxMaterial(const GgxParameters& parameters) : parameters_(parameters), sampler_(parameters) {}

  const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& /*site*/, const PrepareOptions& /*options*/,
                              ScratchArena& arena) const override {
    return arena.make<PreparedGgx>(parameters_, sampler_, wv);
  }

  bool isotropic() const override { return parameters_.alpha.x == parameters_.alpha.y; }

 private:
  GgxParameters parameters_;
  GgxSampler sampler_;
};

}  // namespace

std::shared_ptr<const Material> make_ggx_material(const GgxParameters& parameters) {
  return std::make_shared<GgxMaterial>(parameters);
}

}  // namespace velour
