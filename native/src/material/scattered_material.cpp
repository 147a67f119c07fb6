#include "material/scattered_material.h"

#include <algorithm>

#include "material/measured_values.h"
#include "material/scattered_lobes.h"

namespace velour {

namespace {

/// What the two materials share: samples and density of few lobes that resemble the model.
class LobeSampledMaterial : public Material {
 public:
  LobeSampledMaterial(const ScatteredBrdf& brdf, int neighbors) : lobes_(brdf, neighbors) {}

  void sample(const PreparedBrdf& point, std::span<const Vec2> u, DirectionBatch& wl) const override {
    sample_mixture(point.draws, u, wl);
  }

  bool proposal_lobes(const PreparedBrdf& point, ProposalLobes& lobes) const override {
    lobes_.propose(lobes_.place(point.wv), lobes);
    return true;
  }

 protected:
  ScatteredLobes lobes_;
};

class ScatteredMaterial final : public LobeSampledMaterial {
 public:
  using LobeSampledMaterial::LobeSampledMaterial;

  void prepare(const Vec3& wv, const SurfaceSite& /*site*/, PreparedBrdf& point) const override {
    const ScatteredLobes::Placement placed = lobes_.place(wv);
    point.wv = wv;
    lobes_.gather(placed, point.lobes);
    lobes_.gather_draws(placed, point.draws);
  }

  void eval(const PreparedBrdf& point, const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    eval_mixture(point.lobes, wl, f, pdf);  // its density, the model's own, is overwritten
    eval_density(point.draws, wl, pdf);
    for (int i = 0; i < wl.count; ++i) {
      // The lobes hold f cos, which stays finite at the horizon where f does not: the floor keeps the quotient finite,
      // and f times the cosine is the lobes' value down to cosines far below what a float direction can hold.
      const float scale = wl.z[i] > 0 ? 1 / std::max(wl.z[i], 1e-20f) : 0;
      f.r[i] = std::max(f.r[i], 0.0f) * scale;
      f.g[i] = std::max(f.g[i], 0.0f) * scale;
      f.b[i] = std::max(f.b[i], 0.0f) * scale;
    }
  }

  bool isotropic() const override { return lobes_.isotropic(); }
};

class MeasuredScatteredMaterial final : public LobeSampledMaterial {
 public:
  MeasuredScatteredMaterial(std::shared_ptr<const Measurement> measurement, const ScatteredBrdf& proposal,
                            int neighbors)
      : LobeSampledMaterial(proposal, neighbors), measurement_(std::move(measurement)) {}

  void prepare(const Vec3& wv, const SurfaceSite& /*site*/, PreparedBrdf& point) const override {
    point.wv = wv;
    lobes_.gather_draws(lobes_.place(wv), point.draws);
  }

  void eval(const PreparedBrdf& point, const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    eval_density(point.draws, wl, pdf);
    measured_values(*measurement_, point.wv, wl, f);
  }

  bool isotropic() const override { return measurement_->isotropic(); }

 private:
  std::shared_ptr<const Measurement> measurement_;
};

}  // namespace

std::shared_ptr<const Material> make_scattered_material(std::shared_ptr<const ScatteredBrdf> brdf, int neighbors) {
  return std::make_shared<ScatteredMaterial>(*brdf, neighbors);
}

std::shared_ptr<const Material> make_measured_material(std::shared_ptr<const Measurement> measurement,
                                                       std::shared_ptr<const ScatteredBrdf> proposal, int neighbors) {
  return std::make_shared<MeasuredScatteredMaterial>(std::move(measurement), *proposal, neighbors);
}

}  // namespace velour
