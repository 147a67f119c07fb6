#include "material/view_factored_material.h"

#include "btf/component_ranges.h"
#include "btf/pair_interpolation.h"
#include "material/cosine_btf_material.h"
#include "material/texel_taps.h"

namespace velour {
namespace {

static_assert(3 * FactoredBtf::kMaxOfView <= FactoredPoint::kMost);

class ViewFactoredMaterial final : public CosineBtfMaterial {
 public:
  ViewFactoredMaterial(std::shared_ptr<const FactoredBtf> btf, BtfLight light)
      : CosineBtfMaterial(light),
        btf_(std::move(btf)),
        between_(btf_->layout),
        ranges_(*btf_),
        two_sided_(between_.has_lower_side()) {
    light_value_.resize(btf_->pair_value.size());
    halves_to_floats(btf_->pair_value, light_value_);
    for (const TexelLevel& level : btf_->levels) {
      halves_to_floats(level.value, texel_value_.emplace_back(level.value.size()));
    }
  }

  /// Stores the components of the views one after another, each times the weight of its view.
  void prepare(const Vec3& wv, const SurfaceSite& site, PreparedBrdf& point) const override {
    point.wv = wv;
    FactoredPoint& p = point.factored;
    p.back = site.back && two_sided_;
    p.weight = {0, 0, 0};
    const auto views = between_.view(turned(wv, p.back));
    if (!views) return;
    p.weight = views->weight;
    p.view = views->index;
    std::fill_n(p.value, components_at(p), 0.0f);
    visit_texels(site, btf_->levels, [&](size_t level, uint64_t texel, float share) {
      const float* row = texel_value_[level].data() + texel * btf_->components();
      float* sum = p.value;
      for (size_t v = 0; v < 3; ++v) {
        if (p.weight[v] == 0) continue;
        const auto [begin, end] = ranges_.of(p.view[v]);
        for (uint32_t k = begin; k < end; ++k) *sum++ += share * p.weight[v] * row[k];
      }
    });
  }

  Vec2 texels() const override { return Vec2(btf_->grid.width, btf_->grid.height); }

 private:
  uint32_t components_at(const FactoredPoint& p) const {
    uint32_t count = 0;
    for (size_t v = 0; v < 3; ++v) count += p.weight[v] == 0 ? 0 : ranges_.of(p.view[v]).count();
    return count;
  }

  Rgb value(const PreparedBrdf& point, const Vec3& wl) const override {
    const FactoredPoint& p = point.factored;
    if (!(wl.z > 0) || p.weight[0] + p.weight[1] + p.weight[2] == 0) return Rgb(0.0f);
    const auto lights = between_.light(turned_light(wl, p.back));
    if (!lights) return Rgb(0.0f);
    const float* coefficient = p.value;
    Vec3 sum(0.0f);
    for (size_t v = 0; v < 3; ++v) {
      if (p.weight[v] == 0) continue;
      for (int a = 0; a < 3; ++a) {
        const ComponentRanges::Range range = ranges_.of(p.view[v], static_cast<size_t>(a));
        sum[a] += sum_of(range, *lights, coefficient);
        coefficient += range.count();
      }
    }
    const Vec3 color = btf_->axes * sum;
    return {expanded(btf_->companding, color.r), expanded(btf_->companding, color.g),
            expanded(btf_->companding, color.b)};
  }

  /// Sum over the components of one view and axis.
  float sum_of(const ComponentRanges::Range& range, const PairInterpolation::Corners& lights,
               const float* coefficient) const {
    float sum = 0;
    for (size_t l = 0; l < 3; ++l) {
      const float* row = light_value_.data() + lights.index[l] * btf_->components();
      float of_light = 0;
      for (uint32_t k = range.begin; k < range.end; ++k) of_light += coefficient[k - range.begin] * row[k];
      sum += lights.weight[l] * of_light;
    }
    return sum;
  }

  std::shared_ptr<const FactoredBtf> btf_;
  PairInterpolation between_;
  ComponentRanges ranges_;
  bool two_sided_;
  std::vector<float> light_value_;               // [light][component]
  std::vector<std::vector<float>> texel_value_;  // per level: [texel][component]
};

}  // namespace

std::shared_ptr<const Material> make_view_factored_material(std::shared_ptr<const FactoredBtf> btf, BtfLight light) {
  return std::make_shared<ViewFactoredMaterial>(std::move(btf), light);
}

}  // namespace velour
