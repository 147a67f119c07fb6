#include "brdf/eval/per_view_material.h"

#include <algorithm>

#include "brdf/eval/parametric_material.h"
#include "brdf/eval/per_view_lobes.h"
#include "brdf/eval/table_sampler.h"
#include "math/srbf/kernel.h"

namespace velour {

namespace {

bool resolve(const TableSampler& tables, const PerViewBrdf& brdf, const PerViewLobes& lobes) {
  const auto mixture = std::make_unique<LobeMixture>();
  std::vector<TableSampler::Peak> peaks;
  for (size_t view = 0; view < brdf.views.size(); ++view) {
    const Vec3& wv = brdf.views[view];
    if (!(wv.z > 0)) continue;
    lobes.gather(lobes.place(wv), *mixture);
    peaks.clear();
    for (uint32_t j = brdf.first_lobe[view]; j < brdf.first_lobe[view + 1]; ++j) {
      if (!(brdf.center[j].z > 0)) continue;
      DirectionBatch center;
      center.push(brdf.center[j]);
      center.pad();
      RgbBatch f_cos;
      ScalarBatch unused;
      eval_mixture(*mixture, center, f_cos, unused);
      const auto strength = static_cast<double>(std::max(luminance(brdf.coefficient[j]), 0.0f));
      peaks.push_back({strength * kernel_integral(brdf.kernel, static_cast<double>(brdf.bandwidth[j])), center.get(0),
                       static_cast<double>(std::max(luminance(f_cos.get(0)), 0.0f))});
    }
    if (!tables.resolve(wv, peaks)) return false;
  }
  return true;
}

/// Tables of the model's f cos; null if they do not resolve its lobes.
std::shared_ptr<const TableSampler> tables_of(const PerViewBrdf& brdf, const PerViewLobes& lobes) {
  const auto tables = std::make_shared<const TableSampler>(lobes.isotropic(), [&](const Vec3& wv, auto wl, auto f_cos) {
    const auto mixture = std::make_unique<LobeMixture>();
    lobes.gather(lobes.place(wv), *mixture);
    RgbBatch value;
    ScalarBatch unused;
    for (size_t k = 0; k < wl.size(); ++k) {
      eval_mixture(*mixture, wl[k], value, unused);
      for (int i = 0; i < wl[k].count; ++i) f_cos[k].v[i] = wl[k].z[i] > 0 ? luminance(value.get(i)) : 0.0f;
    }
  });
  return resolve(*tables, brdf, lobes) ? tables : nullptr;
}

/// Base class of both materials: samples the model and gives their density. Without usable tables it samples all lobes
/// of the nearest views.
class LobeSampledMaterial : public Material {
 public:
  LobeSampledMaterial(const PerViewBrdf& brdf, int neighbors)
      : lobes_(brdf, neighbors), tables_(tables_of(brdf, lobes_)) {}

  void sample(const PreparedBrdf& point, std::span<const Vec2> u, DirectionBatch& wl) const override {
    if (draws_lobes(point)) return sample_mixture(point.draws, u, wl);
    TableSampler::sample(point.table, u, wl);
  }

  bool proposal_lobes(const PreparedBrdf& point, ProposalLobes& lobes) const override {
    lobes_.propose(lobes_.place(point.wv), lobes);
    return true;
  }

  std::shared_ptr<const TableSampler> tables() const override { return tables_; }

 protected:
  void prepare_draws(const Vec3& wv, PreparedBrdf& point) const {
    if (draws_lobes(point)) return lobes_.gather(lobes_.place_nearest(wv), point.draws);
    tables_->prepare(wv, point.table);
  }
  void pdf_of_draws(const PreparedBrdf& point, const DirectionBatch& wl, ScalarBatch& pdf) const {
    if (draws_lobes(point)) return eval_density(point.draws, wl, pdf);
    TableSampler::pdf(point.table, wl, pdf);
  }

  PerViewLobes lobes_;

 private:
  bool draws_lobes(const PreparedBrdf& point) const { return point.interpolated_draws || tables_ == nullptr; }

  std::shared_ptr<const TableSampler> tables_;
};

class PerViewMaterial final : public LobeSampledMaterial {
 public:
  using LobeSampledMaterial::LobeSampledMaterial;

  void prepare(const Vec3& wv, const SurfaceSite& /*site*/, PreparedBrdf& point) const override {
    point.wv = wv;
    lobes_.gather(lobes_.place(wv), point.lobes);
    prepare_draws(wv, point);
  }

  void eval(const PreparedBrdf& point, const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    eval_mixture(point.lobes, wl, f, pdf);  // its density is overwritten
    pdf_of_draws(point, wl, pdf);
    for (int i = 0; i < wl.count; ++i) {
      // The lobes hold f cos, which is finite at the horizon where f is not. The floor keeps the quotient finite, and f
      // times the cosine equals the lobes' value down to cosines far below the precision of a float direction.
      const float scale = wl.z[i] > 0 ? 1 / std::max(wl.z[i], 1e-20f) : 0;
      f.r[i] = std::max(f.r[i], 0.0f) * scale;
      f.g[i] = std::max(f.g[i], 0.0f) * scale;
      f.b[i] = std::max(f.b[i], 0.0f) * scale;
    }
  }

  bool isotropic() const override { return lobes_.isotropic(); }
};

class MeasuredPerViewMaterial final : public LobeSampledMaterial {
 public:
  MeasuredPerViewMaterial(std::shared_ptr<const Measurement> measurement, const PerViewBrdf& proposal, int neighbors)
      : LobeSampledMaterial(proposal, neighbors), measurement_(std::move(measurement)) {}

  void prepare(const Vec3& wv, const SurfaceSite& /*site*/, PreparedBrdf& point) const override {
    point.wv = wv;
    prepare_draws(wv, point);
  }

  void eval(const PreparedBrdf& point, const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    pdf_of_draws(point, wl, pdf);
    measured_values(*measurement_, point.wv, wl, f);
  }

  bool isotropic() const override { return measurement_->isotropic(); }

 private:
  std::shared_ptr<const Measurement> measurement_;
};

}  // namespace

std::shared_ptr<const Material> make_per_view_material(std::shared_ptr<const PerViewBrdf> brdf, int neighbors) {
  return std::make_shared<PerViewMaterial>(*brdf, neighbors);
}

std::shared_ptr<const Material> make_measured_material(std::shared_ptr<const Measurement> measurement,
                                                       std::shared_ptr<const PerViewBrdf> proposal, int neighbors) {
  return std::make_shared<MeasuredPerViewMaterial>(std::move(measurement), *proposal, neighbors);
}

}  // namespace velour
