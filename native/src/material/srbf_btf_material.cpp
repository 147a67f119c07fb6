#include "material/srbf_btf_material.h"

#include <optional>

#include "material/footprint_taps.h"
#include "material/srbf_btf_draws.h"
#include "sphere/warp.h"

namespace velour {
namespace {

class SrbfBtfMaterial final : public Material {
 public:
  explicit SrbfBtfMaterial(std::shared_ptr<const SrbfBtf> btf) : evaluator_(std::move(btf)) {
    for (const bool below : {false, true}) {
      const auto side = evaluator_.side(below, below);
      if (side) sides_[below] = {*side, SrbfBtfDraws(evaluator_, *side)};
    }
  }

  void prepare(const Vec3& wv, const SurfaceSite& site, PreparedBrdf& point) const override {
    point.wv = wv;
    SrbfPoint& p = point.srbf;
    const auto& side = side_of(site);
    p.seen = side.has_value();
    if (!p.seen) return;
    evaluator_.begin(side->number, wv, p);
    const FootprintTaps taps = footprint_taps(site.footprint, evaluator_.texels());
    for (int i = 0; i < taps.count; ++i) {
      evaluator_.add(taps.place(site.uv, i), taps.level, 1.0f / static_cast<float>(taps.count), p);
    }
    evaluator_.finish(p);
    side->draws.fill(evaluator_, p, point.warped);
  }

  void eval(const PreparedBrdf& point, const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    if (!point.srbf.seen) return eval_unseen(wl, f, pdf);
    eval_warped(point.warped, wl, f, pdf);  // its value, 0, is overwritten
    for (int i = 0; i < wl.count; ++i) f.set(i, value(point, wl.get(i)));
  }

  Reflection eval_one(const PreparedBrdf& point, const Vec3& wl) const override {
    if (!point.srbf.seen) return {Rgb(0.0f), pdf_cosine_hemisphere(wl)};
    Reflection result;
    eval_warped(point.warped, wl, result.f, result.pdf);
    result.f = value(point, wl);
    return result;
  }

  void sample(const PreparedBrdf& point, std::span<const Vec2> u, DirectionBatch& wl) const override {
    if (point.srbf.seen) return sample_warped(point.warped, u, wl);
    wl.fill(u, [](const Vec2& v) { return sample_cosine_hemisphere(v); });
  }

  bool proposal_lobes(const PreparedBrdf& point, ProposalLobes& lobes) const override {
    if (!point.srbf.seen) return false;
    SrbfBtfDraws::propose(point.warped, lobes);
    return true;
  }

  bool varies() const override { return true; }
  bool isotropic() const override { return false; }

 private:
  struct Side {
    uint32_t number;
    SrbfBtfDraws draws;
  };

  /// A BTF of one side shows it from behind as well.
  const std::optional<Side>& side_of(const SurfaceSite& site) const { return sides_[site.back && sides_[1]]; }

  Rgb value(const PreparedBrdf& point, const Vec3& wl) const {
    return wl.z > 0 ? evaluator_.value(point.srbf, wl) : Rgb(0.0f);
  }

  static void eval_unseen(const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) {
    for (int i = 0; i < wl.count; ++i) {
      f.set(i, Rgb(0.0f));
      pdf.v[i] = pdf_cosine_hemisphere(wl.get(i));
    }
  }

  SrbfEvaluator evaluator_;
  std::array<std::optional<Side>, 2> sides_;  // seen and lit from the front, from behind
};

}  // namespace

std::shared_ptr<const Material> make_srbf_btf_material(std::shared_ptr<const SrbfBtf> btf) {
  return std::make_shared<SrbfBtfMaterial>(std::move(btf));
}

}  // namespace velour
