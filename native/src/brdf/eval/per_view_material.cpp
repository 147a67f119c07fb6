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

/// Base class of both materials.
class LobeSampledMaterial : public Material {
 public:
  LobeSampledMaterial(const PerViewBrdf& brdf, int neighbors)
      : lobes_(brdf, neighbors), tables_(tables_of(brdf, lobes_)) {}

  const PerViewLobes& lobes() const { return lobes_; }
  const TableSampler* usable_tables() const { return tables_.get(); }  // null: none
  std::shared_ptr<const TableSampler> tables() const override { return tables_; }

 private:
  PerViewLobes lobes_;
  std::shared_ptr<const TableSampler> tables_;
};

/// Samples and densities of the model at a view: of its tables, otherwise of all lobes of the nearest views.
class PreparedProposal {
 public:
  PreparedProposal(const LobeSampledMaterial& material, const Vec3& wv, const PrepareOptions& options,
                   ScratchArena& arena)
      : lobes_(material.lobes()), wv_(wv) {
    if (const TableSampler* const tables = material.usable_tables(); tables != nullptr && !options.interpolated_draws) {
      tables->prepare(wv, table_);
      return;
    }
    LobeMixture* const draws = arena.make<LobeMixture>();
    lobes_.gather(lobes_.place_nearest(wv), *draws);
    draws_ = draws;
  }

  void sample(std::span<const Vec2> u, DirectionBatch& wl) const {
    if (draws_ != nullptr) return sample_mixture(*draws_, u, wl);
    TableSampler::sample(table_, u, wl);
  }

  void pdf(const DirectionBatch& wl, ScalarBatch& pdf) const {
    if (draws_ != nullptr) return eval_density(*draws_, wl, pdf);
    TableSampler::pdf(table_, wl, pdf);
  }

  void lobes(ProposalLobes& lobes) const { lobes_.propose(lobes_.place(wv_), lobes); }

 private:
  const PerViewLobes& lobes_;
  Vec3 wv_;
  const LobeMixture* draws_ = nullptr;  // null: the tables are sampled
  TablePoint table_;
};

class PreparedPerView final : public PreparedBrdf {
 public:
  PreparedPerView(const LobeSampledMaterial& material, const Vec3& wv, const PrepareOptions& options,
                  ScratchArena& arena)
      : proposal_(material, wv, options, arena) {
    material.lobes().gather(material.lobes().place(wv), lobes_);
  }

  void eval(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    eval_mixture(lobes_, wl, f, pdf);  // its density is overwritten
    proposal_.pdf(wl, pdf);
    for (int i = 0; i < wl.count; ++i) {
      // The lobes hold f cos, which is finite at the horizon where f is not. The floor keeps the quotient finite, and f
      // times the cosine equals the lobes' value down to cosines far below the precision of a float direction.
      const float scale = wl.z[i] > 0 ? 1 / std::max(wl.z[i], 1e-20f) : 0;
      f.r[i] = std::max(f.r[i], 0.0f) * scale;
      f.g[i] = std::max(f.g[i], 0.0f) * scale;
      f.b[i] = std::max(f.b[i], 0.0f) * scale;
    }
  }

  void sample(std::span<const Vec2> u, DirectionBatch& wl) const override { proposal_.sample(u, wl); }

  bool proposal_lobes(ProposalLobes& lobes) const override {
    proposal_.lobes(lobes);
    return true;
  }

 private:
  PreparedProposal proposal_;
  LobeMixture lobes_;
};

class PerViewMaterial final : public LobeSampledMaterial {
 public:
  using LobeSampledMaterial::LobeSampledMaterial;

  const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& /*site*/, const PrepareOptions& options,
                              ScratchArena& arena) const override {
    return arena.make<PreparedPerView>(*this, wv, options, arena);
  }

  bool isotropic() const override { return lobes().isotropic(); }
};

class PreparedMeasuredByViews final : public PreparedBrdf {
 public:
  PreparedMeasuredByViews(const Measurement& measurement, const LobeSampledMaterial& material, const Vec3& wv,
                          const PrepareOptions& options, ScratchArena& arena)
      : measurement_(measurement), wv_(wv), proposal_(material, wv, options, arena) {}

  void eval(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    proposal_.pdf(wl, pdf);
    measured_values(measurement_, wv_, wl, f);
  }

  void sample(std::span<const Vec2> u, DirectionBatch& wl) const override { proposal_.sample(u, wl); }

  bool proposal_lobes(ProposalLobes& lobes) const override {
    proposal_.lobes(lobes);
    return true;
  }

 private:
  const Measurement& measurement_;
  Vec3 wv_;
  PreparedProposal proposal_;
};

class MeasuredPerViewMaterial final : public LobeSampledMaterial {
 public:
  MeasuredPerViewMaterial(std::shared_ptr<const Measurement> measurement, const PerViewBrdf& proposal, int neighbors)
      : LobeSampledMaterial(proposal, neighbors), measurement_(std::move(measurement)) {}

  const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& /*site*/, const PrepareOptions& options,
                              ScratchArena& arena) const override {
    return arena.make<PreparedMeasuredByViews>(*measurement_, *this, wv, options, arena);
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
