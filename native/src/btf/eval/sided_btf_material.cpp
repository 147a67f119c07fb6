#include "btf/eval/sided_btf_material.h"

#include "btf/model/srbf_evaluator.h"
#include "btf/model/tensor_evaluator.h"

namespace velour {

std::shared_ptr<const Material> make_srbf_btf_material(std::shared_ptr<const SrbfBtf> btf, BtfLight light) {
  return std::make_shared<SidedBtfMaterial<SrbfEvaluator>>(std::move(btf), light);
}

std::shared_ptr<const Material> make_tensor_btf_material(std::shared_ptr<const TensorBtf> btf, BtfLight light) {
  return std::make_shared<SidedBtfMaterial<TensorEvaluator>>(std::move(btf), light);
}

namespace {

/// The BTF at a point close to a silhouette.
class PreparedFold final : public PreparedBrdf {
 public:
  /// `beyond`: the point mirrored in the silhouette; only its value is used.
  PreparedFold(const PreparedBrdf* inside, const PreparedBrdf* beyond) : inside_(inside), beyond_(beyond) {}

  void eval(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    beyond_->eval(wl, f, pdf);
    RgbBatch inside;
    inside_->eval(wl, inside, pdf);
    for (int i = 0; i < wl.count; ++i) f.set(i, inside.get(i) + f.get(i));
  }
  Reflection eval_one(const Vec3& wl) const override {
    Reflection sum = inside_->eval_one(wl);
    sum.f += beyond_->eval_one(wl).f;
    return sum;
  }

  void sample(std::span<const Vec2> u, DirectionBatch& wl) const override { inside_->sample(u, wl); }
  Vec3 sample_one(const Vec2& u) const override { return inside_->sample_one(u); }
  float diffuse_share(const Vec3& wl, float pdf) const override { return inside_->diffuse_share(wl, pdf); }
  bool proposal_lobes(ProposalLobes& lobes) const override { return inside_->proposal_lobes(lobes); }

 private:
  const PreparedBrdf *inside_, *beyond_;
};

}  // namespace

const PreparedBrdf* HoledBtfMaterial::prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                                              ScratchArena& arena) const {
  const PreparedBrdf* const inside = btf_->prepare(wv, site, options, arena);
  if (site.beyond_outline == Vec2(0.0f)) return inside;
  SurfaceSite beyond = site;
  beyond.uv += site.beyond_outline;
  PrepareOptions value_only = options;
  value_only.value_only = true;
  return arena.make<PreparedFold>(inside, btf_->prepare(wv, beyond, value_only, arena));
}

}  // namespace velour
