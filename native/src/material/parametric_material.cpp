#include "material/parametric_material.h"

#include "material/measured_values.h"
#include "material/parametric_table.h"

namespace velour {

namespace {

class ParametricMaterial : public Material {
 public:
  explicit ParametricMaterial(const ParametricBrdf& brdf) : values_(brdf), draws_(values_), table_(values_, draws_) {}

  void prepare(const Vec3& wv, const SurfaceSite& /*site*/, PreparedBrdf& point) const override {
    point.wv = wv;
    evaluate(wv, point.warped);
  }

  void eval(const PreparedBrdf& point, const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    eval_warped(point.warped, wl, f, pdf);
  }

  Reflection eval_one(const PreparedBrdf& point, const Vec3& wl) const override {
    Reflection result;
    eval_warped(point.warped, wl, result.f, result.pdf);
    return result;
  }

  void sample(const PreparedBrdf& point, std::span<const Vec2> u, DirectionBatch& wl) const override {
    sample_warped(point.warped, u, wl);
  }

  Vec3 sample_one(const PreparedBrdf& point, const Vec2& u) const override { return sample_warped(point.warped, u); }

  bool proposal_lobes(const PreparedBrdf& point, ProposalLobes& lobes) const override {
    draws_.propose(point.warped, lobes);
    return true;
  }

  bool isotropic() const override { return values_.isotropic(); }

 protected:
  void evaluate(const Vec3& wv, WarpedMixture& mixture) const {
    if (table_.covers(wv)) return table_.evaluate(wv, mixture);
    const ViewPlace place(wv);
    values_.evaluate(wv, place, mixture);
    draws_.add_to(place, mixture);
  }

 private:
  ParametricValues values_;
  ParametricDraws draws_;
  ParametricTable table_;
};

/// f is the mean of both orders of a pair; samples are those of the lobes.
class SymmetricMaterial final : public ParametricMaterial {
 public:
  using ParametricMaterial::ParametricMaterial;

  void eval(const PreparedBrdf& point, const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    ParametricMaterial::eval(point, wl, f, pdf);
    for (int i = 0; i < wl.count; ++i) f.set(i, mean(point, wl.get(i), f.get(i)));
  }

  Reflection eval_one(const PreparedBrdf& point, const Vec3& wl) const override {
    Reflection result = ParametricMaterial::eval_one(point, wl);
    result.f = mean(point, wl, result.f);
    return result;
  }

 private:
  Rgb mean(const PreparedBrdf& point, const Vec3& wl, const Rgb& f) const {
    if (!(wl.z > 0)) return Rgb(0);
    WarpedMixture exchanged;
    evaluate(wl, exchanged);
    Rgb other;
    float unused;
    eval_warped(exchanged, point.wv, other, unused);
    return 0.5f * (f + other);
  }
};

class MeasuredParametricMaterial final : public ParametricMaterial {
 public:
  MeasuredParametricMaterial(std::shared_ptr<const Measurement> measurement, const ParametricBrdf& proposal)
      : ParametricMaterial(proposal), measurement_(std::move(measurement)) {}

  void eval(const PreparedBrdf& point, const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    ParametricMaterial::eval(point, wl, f, pdf);  // its value, the model's, is overwritten
    measured_values(*measurement_, point.wv, wl, f);
  }

  Reflection eval_one(const PreparedBrdf& point, const Vec3& wl) const override {
    return Material::eval_one(point, wl);
  }

  bool isotropic() const override { return measurement_->isotropic(); }

 private:
  std::shared_ptr<const Measurement> measurement_;
};

}  // namespace

std::shared_ptr<const Material> make_parametric_material(const std::shared_ptr<const ParametricBrdf>& brdf) {
  if (brdf->symmetric) return std::make_shared<SymmetricMaterial>(*brdf);
  return std::make_shared<ParametricMaterial>(*brdf);
}

std::shared_ptr<const Material> make_measured_material(std::shared_ptr<const Measurement> measurement,
                                                       const std::shared_ptr<const ParametricBrdf>& proposal) {
  return std::make_shared<MeasuredParametricMaterial>(std::move(measurement), *proposal);
}

}  // namespace velour
