#include "material/material.h"
#include "material/microfacet/ggx_sampler.h"

namespace velour {

namespace {

class GgxMaterial final : public Material {
 public:
  explicit GgxMaterial(const GgxParameters& parameters) : parameters_(parameters), sampler_(parameters) {}

  void prepare(const Vec3& wv, const SurfaceSite& /*site*/, PreparedBrdf& point) const override {
    sampler_.prepare(point.wv = wv, point.ggx);
  }

  void eval(const PreparedBrdf& point, const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    for (int i = 0; i < wl.count; ++i) {
      f.set(i, wl.z[i] > 0 ? ggx_model(parameters_, {.wl = wl.get(i), .wv = point.wv}) : Rgb(0));
    }
    sampler_.pdf(point.ggx, wl, pdf);
  }

  void sample(const PreparedBrdf& point, std::span<const Vec2> u, DirectionBatch& wl) const override {
    wl.fill(u, [&](const Vec2& v) { return sampler_.sample(point.ggx, v); });
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
