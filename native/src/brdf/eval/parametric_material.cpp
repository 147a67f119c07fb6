#include "brdf/eval/parametric_material.h"

#include <algorithm>
#include "brdf/eval/parametric_table.h"
#include "brdf/eval/table_sampler.h"
#include "material/material.h"
#include "math/sphere/directions.h"
#include "math/srbf/kernel.h"
#include "math/srbf/warped_mixture.h"

namespace velour {

namespace {

class ParametricMaterial : public Material {
 public:
  explicit ParametricMaterial(const ParametricBrdf& brdf) : values_(brdf), nodes_(values_), table_(values_, nodes_) {}

  /// Must be called once, before first use.
  void tabulate_draws() {
    const auto tables = std::make_shared<const TableSampler>(isotropic(), [this](const Vec3& wv, auto wl, auto f_cos) {
      WarpedMixture mixture;
      evaluate(wv, mixture);
      RgbBatch f;
      for (size_t k = 0; k < wl.size(); ++k) {
        value(wv, mixture, wl[k], f);
        for (int i = 0; i < wl[k].count; ++i) f_cos[k].v[i] = luminance(f.get(i)) * std::max(wl[k].z[i], 0.0f);
      }
    });
    if (serves(*tables)) tables_ = tables;
  }

  const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                              ScratchArena& arena) const override;

  std::shared_ptr<const TableSampler> tables() const override { return tables_; }
  bool isotropic() const override { return values_.isotropic(); }
  void propose(const Vec3& wv, ProposalLobes& lobes) const { nodes_.propose(wv, lobes); }

  /// The lobes at `wv`.
  void evaluate(const Vec3& wv, WarpedMixture& mixture) const {
    if (table_.covers(wv)) return table_.evaluate(wv, mixture);
    values_.evaluate(wv, ViewPlace(wv), mixture);
  }

  /// f from `mixture`, the lobes at `wv`.
  virtual void value(const Vec3& /*wv*/, const WarpedMixture& mixture, const DirectionBatch& wl, RgbBatch& f) const {
    eval_warped(mixture, wl, f);
  }
  virtual Rgb value(const Vec3& /*wv*/, const WarpedMixture& mixture, const Vec3& wl) const {
    return eval_warped(mixture, wl);
  }

 private:
  /// Whether the tables resolve all lobes, tested at views between their nodes. Lobes narrower than a table's cells are
  /// rare except in models made by hand; those are sampled directly.
  bool serves(const TableSampler& tables) const {
    constexpr int kViews = 24, kTurns = 8;
    for (int i = 0; i < kViews; ++i) {
      for (int k = 0; k < (isotropic() ? 1 : kTurns); ++k) {
        const float theta = 0.5f * kPi * (static_cast<float>(i) + 0.4f) / kViews;
        const Vec3 wv = direction(theta, 2 * kPi * (static_cast<float>(k) + 0.3f) / kTurns);
        WarpedMixture mixture;
        evaluate(wv, mixture);
        if (!tables.resolve(wv, peaks_of(wv, mixture))) return false;
      }
    }
    return true;
  }

  std::vector<TableSampler::Peak> peaks_of(const Vec3& wv, const WarpedMixture& mixture) const {
    std::vector<TableSampler::Peak> peaks;
    const Vec3d own_wv(mixture.wv);
    for (const WarpedLobe& lobe : lobes_of(mixture)) {
      const auto at = unwarped(lobe, lobe.center, own_wv);
      if (!at || !(at->z > 1e-6)) continue;
      const float c = mixture.turn_cos, s = mixture.turn_sin;
      const Vec3 own(*at), wl(c * own.x - s * own.y, s * own.x + c * own.y, own.z);
      const auto brightness = static_cast<double>(luminance(Rgb(lobe.coefficient)));
      const double integral = kernel_integral(Kernel::gaussian, lobe.bandwidth) / warp_jacobian(lobe, *at, own_wv);
      peaks.push_back(
          {brightness * integral * at->z, wl, static_cast<double>(luminance(value(wv, mixture, wl)) * wl.z)});
    }
    return peaks;
  }

  ParametricValues values_;
  ParametricNodes nodes_;
  ParametricTable table_;
  std::shared_ptr<const TableSampler> tables_;
};

/// The lobes at a view. Samples come from the tables, otherwise from the lobes.
class PreparedParametric final : public PreparedBrdf {
 public:
  PreparedParametric(const ParametricMaterial& material, const TableSampler* tables, const Vec3& wv)
      : material_(material), tables_(tables), wv_(wv) {
    material.evaluate(wv, lobes_);
    if (tables == nullptr) draw_plain_lobes(lobes_, kDefensiveShare);
    if (tables != nullptr) tables->prepare(wv, table_);
  }

  void eval(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    if (tables_ == nullptr) eval_warped(lobes_, wl, f, pdf);
    material_.value(wv_, lobes_, wl, f);
    if (tables_ != nullptr) TableSampler::pdf(table_, wl, pdf);
  }

  Reflection eval_one(const Vec3& wl) const override {
    Reflection result{material_.value(wv_, lobes_, wl), 0};
    Rgb unused;
    if (tables_ == nullptr) eval_warped(lobes_, wl, unused, result.pdf);
    if (tables_ != nullptr) result.pdf = TableSampler::pdf(table_, wl);
    return result;
  }

  void sample(std::span<const Vec2> u, DirectionBatch& wl) const override {
    if (tables_ == nullptr) return sample_warped(lobes_, u, wl);
    TableSampler::sample(table_, u, wl);
  }

  bool proposal_lobes(ProposalLobes& lobes) const override {
    material_.propose(wv_, lobes);
    return true;
  }

 private:
  const ParametricMaterial& material_;
  const TableSampler* tables_;  // null: none
  Vec3 wv_;
  TablePoint table_;
  WarpedMixture lobes_;
};

const PreparedBrdf* ParametricMaterial::prepare(const Vec3& wv, const SurfaceSite& /*site*/,
                                                const PrepareOptions& /*options*/, ScratchArena& arena) const {
  return arena.make<PreparedParametric>(*this, tables_.get(), wv);
}

/// f is averaged over both orders of a direction pair.
class SymmetricMaterial final : public ParametricMaterial {
 public:
  using ParametricMaterial::ParametricMaterial;

  void value(const Vec3& wv, const WarpedMixture& mixture, const DirectionBatch& wl, RgbBatch& f) const override {
    eval_warped(mixture, wl, f);
    for (int i = 0; i < wl.count; ++i) f.set(i, mean(wv, wl.get(i), f.get(i)));
  }
  Rgb value(const Vec3& wv, const WarpedMixture& mixture, const Vec3& wl) const override {
    return mean(wv, wl, eval_warped(mixture, wl));
  }

 private:
  Rgb mean(const Vec3& wv, const Vec3& wl, const Rgb& f) const {
    if (!(wl.z > 0)) return Rgb(0);
    WarpedMixture exchanged;
    evaluate(wl, exchanged);
    return 0.5f * (f + eval_warped(exchanged, wv));
  }
};

/// f of a measurement; samples and densities of a model.
class PreparedMeasured final : public PreparedBrdf {
 public:
  /// `proposal`: the model at the view; null: `tables` are sampled.
  PreparedMeasured(const Measurement& measurement, const ParametricMaterial& model, const Vec3& wv,
                   const PreparedBrdf* proposal, const TableSampler* tables)
      : measurement_(measurement), model_(model), wv_(wv), proposal_(proposal) {
    if (tables != nullptr) tables->prepare(wv, table_);
  }

  void eval(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    if (proposal_ != nullptr) {
      proposal_->eval(wl, f, pdf);  // its value is overwritten
    } else {
      TableSampler::pdf(table_, wl, pdf);
    }
    measured_values(measurement_, wv_, wl, f);
  }

  void sample(std::span<const Vec2> u, DirectionBatch& wl) const override {
    if (proposal_ != nullptr) return proposal_->sample(u, wl);
    TableSampler::sample(table_, u, wl);
  }

  bool proposal_lobes(ProposalLobes& lobes) const override {
    model_.propose(wv_, lobes);
    return true;
  }

 private:
  const Measurement& measurement_;
  const ParametricMaterial& model_;
  Vec3 wv_;
  const PreparedBrdf* proposal_;
  TablePoint table_;
};

class MeasuredParametricMaterial final : public Material {
 public:
  MeasuredParametricMaterial(std::shared_ptr<const Measurement> measurement,
                             std::shared_ptr<const ParametricMaterial> proposal)
      : measurement_(std::move(measurement)), proposal_(std::move(proposal)), tables_(proposal_->tables()) {}

  const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                              ScratchArena& arena) const override {
    const PreparedBrdf* const proposal = tables_ == nullptr ? proposal_->prepare(wv, site, options, arena) : nullptr;
    return arena.make<PreparedMeasured>(*measurement_, *proposal_, wv, proposal, tables_.get());
  }

  std::shared_ptr<const TableSampler> tables() const override { return tables_; }
  bool isotropic() const override { return measurement_->isotropic(); }

 private:
  std::shared_ptr<const Measurement> measurement_;
  std::shared_ptr<const ParametricMaterial> proposal_;
  std::shared_ptr<const TableSampler> tables_;
};

template <class M>
std::shared_ptr<const M> with_draws(const ParametricBrdf& brdf) {
  const auto material = std::make_shared<M>(brdf);
  material->tabulate_draws();
  return material;
}

}  // namespace

std::shared_ptr<const Material> make_parametric_material(const std::shared_ptr<const ParametricBrdf>& brdf) {
  if (brdf->symmetric) return with_draws<SymmetricMaterial>(*brdf);
  return with_draws<ParametricMaterial>(*brdf);
}

std::shared_ptr<const Material> make_measured_material(std::shared_ptr<const Measurement> measurement,
                                                       const std::shared_ptr<const ParametricBrdf>& proposal) {
  return std::make_shared<MeasuredParametricMaterial>(std::move(measurement),
                                                      with_draws<ParametricMaterial>(*proposal));
}

void measured_values(const Measurement& measurement, const Vec3& wv, const DirectionBatch& wl, RgbBatch& f) {
  Vec3 directions[DirectionBatch::kCapacity];
  Rgb measured[DirectionBatch::kCapacity];
  uint8_t covered[DirectionBatch::kCapacity];
  const auto count = static_cast<size_t>(wl.count);
  for (int i = 0; i < wl.count; ++i) directions[i] = wl.get(i);
  measurement.eval(wv, {directions, count}, {measured, count}, {covered, count});
  for (int i = 0; i < wl.count; ++i) {
    f.set(i, covered[i] && wl.z[i] > 0 ? glm::max(measured[i], Rgb(0)) : Rgb(0));
  }
}

}  // namespace velour
