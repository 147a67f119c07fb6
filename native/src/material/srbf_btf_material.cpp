#include "material/srbf_btf_material.h"

#include "btf/srbf_evaluator.h"
#include "material/footprint_taps.h"
#include "sphere/warp.h"

namespace velour {
namespace {

class SrbfBtfMaterial final : public Material {
 public:
  explicit SrbfBtfMaterial(std::shared_ptr<const SrbfBtf> btf)
      : evaluator_(std::move(btf)), sides_{evaluator_.side(false, false), evaluator_.side(true, true)} {}

  void prepare(const Vec3& wv, const SurfaceSite& site, PreparedBrdf& point) const override {
    point.wv = wv;
    SrbfPoint& p = point.srbf;
    // A BTF of one side shows it from behind as well.
    const auto& side = site.back && sides_[1] ? sides_[1] : sides_[0];
    p.seen = side.has_value();
    if (!p.seen) return;
    evaluator_.begin(*side, wv, p);
    const FootprintTaps taps = footprint_taps(site.footprint, evaluator_.texels());
    for (int i = 0; i < taps.count; ++i) {
      evaluator_.add(taps.place(site.uv, i), taps.level, 1.0f / static_cast<float>(taps.count), p);
    }
    evaluator_.finish(p);
  }

  void eval(const PreparedBrdf& point, const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override {
    for (int i = 0; i < wl.count; ++i) {
      const Vec3 direction = wl.get(i);
      f.set(i, point.srbf.seen && direction.z > 0 ? evaluator_.value(point.srbf, direction) : Rgb(0.0f));
      pdf.v[i] = pdf_cosine_hemisphere(direction);
    }
  }

  void sample(const PreparedBrdf& /*point*/, std::span<const Vec2> u, DirectionBatch& wl) const override {
    wl.fill(u, [](const Vec2& v) { return sample_cosine_hemisphere(v); });
  }

  bool varies() const override { return true; }
  Vec2 texels() const override { return evaluator_.texels(); }
  bool isotropic() const override { return false; }

 private:
  SrbfEvaluator evaluator_;
  std::array<std::optional<uint32_t>, 2> sides_;  // seen from the front, from behind, lit from there
};

}  // namespace

std::shared_ptr<const Material> make_srbf_btf_material(std::shared_ptr<const SrbfBtf> btf) {
  return std::make_shared<SrbfBtfMaterial>(std::move(btf));
}

}  // namespace velour
