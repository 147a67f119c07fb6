#include "btf/eval/factored_material.h"

#include <algorithm>
#include <array>

#include "btf/eval/factored_sums.h"
#include "btf/eval/measured_btf_material.h"
#include "btf/measure/pair_interpolation.h"
#include "btf/model/factored_btf.h"
#include "material/footprint_taps.h"

namespace velour {
namespace {

static_assert(FactoredPoint::kMost >= FactoredBtf::kMaxComponents + kFactoredSlack);
static_assert(FactoredPoint::kMost >= 3 * FactoredBtf::kMaxOfView + kFactoredSlack);

/// Halves as floats, with room for what weighted_dot() reads beyond the last row.
std::vector<float> floats_of(const std::vector<HalfBits>& halves) {
  std::vector<float> floats(halves.size() + kFactoredSlack, 0.0f);
  halves_to_floats(halves, std::span(floats).first(halves.size()));
  return floats;
}

class FactoredMaterial final : public CosineBtfMaterial {
 public:
  FactoredMaterial(std::shared_ptr<const FactoredBtf> btf, BtfLight light)
      : CosineBtfMaterial(light),
        btf_(std::move(btf)),
        between_(btf_->layout),
        ranges_(*btf_),
        two_sided_(between_.has_lower_side()),
        by_view_(btf_->by_view()),
        function_(floats_of(btf_->pair_value)) {
    for (const TexelLevel& level : btf_->levels) texel_value_.push_back(floats_of(level.value));
  }

  void prepare(const Vec3& wv, const SurfaceSite& site, PreparedBrdf& point) const override {
    point.wv = wv;
    FactoredPoint& p = point.factored;
    p.back = site.back && two_sided_;
    p.weight = {0, 0, 0};
    const auto views = between_.view(turned(wv, p.back));
    if (!views) return;
    p.weight = views->weight;
    p.view = views->index;
    std::fill_n(p.value, by_view_ ? components_at(p) : btf_->components(), 0.0f);
    visit_texels(site, btf_->levels, [&](size_t level, uint64_t texel, float share) {
      add_texel(texel_value_[level].data() + texel * btf_->components(), share, p);
    });
  }

  Vec2 texels() const override { return Vec2(btf_->grid.width, btf_->grid.height); }

 private:
  using Rows = std::array<WeightedRow, 9>;

  uint32_t components_at(const FactoredPoint& p) const {
    uint32_t count = 0;
    for (size_t v = 0; v < 3; ++v) count += p.weight[v] == 0 ? 0 : ranges_.of(p.view[v]).count();
    return count;
  }

  /// Adds a texel's coefficients: those of all components, or of each view one after the other, times its weight.
  void add_texel(const float* row, float share, FactoredPoint& p) const {
    if (!by_view_) return add_weighted({row, share}, static_cast<uint32_t>(btf_->components()), p.value);
    float* sum = p.value;
    for (size_t v = 0; v < 3; ++v) {
      if (p.weight[v] == 0) continue;
      const ComponentRanges::Range range = ranges_.of(p.view[v]);
      add_weighted({row + range.begin, share * p.weight[v]}, range.count(), sum);
      sum += range.count();
    }
  }

  Rgb value(const PreparedBrdf& point, const Vec3& wl) const override {
    const FactoredPoint& p = point.factored;
    if (!(wl.z > 0) || p.weight[0] + p.weight[1] + p.weight[2] == 0) return Rgb(0.0f);
    const auto lights = between_.light(turned_light(wl, p.back));
    if (!lights) return Rgb(0.0f);
    const Vec3 color = btf_->axes * (by_view_ ? sum_by_view(p, *lights) : sum_of_pairs(p, *lights));
    return {expanded(btf_->companding, color.r), expanded(btf_->companding, color.g),
            expanded(btf_->companding, color.b)};
  }

  /// Components that serve all views: nine functions of direction pairs.
  Vec3 sum_of_pairs(const FactoredPoint& p, const PairInterpolation::Corners& lights) const {
    Rows rows;
    size_t count = 0;
    for (size_t v = 0; v < 3; ++v) {
      const uint64_t first = btf_->layout.first(p.view[v]);
      for (size_t l = 0; l < 3; ++l) {
        const float weight = p.weight[v] * lights.weight[l];
        if (weight > 0) rows[count++] = {function(first + lights.index[l]), weight};
      }
    }
    return sum_of({rows.data(), count}, p.view[0], p.value);
  }

  /// Components that serve one view each: three functions of lights for each view.
  Vec3 sum_by_view(const FactoredPoint& p, const PairInterpolation::Corners& lights) const {
    Rows rows;
    size_t count = 0;
    for (size_t l = 0; l < 3; ++l) {
      if (lights.weight[l] > 0) rows[count++] = {function(lights.index[l]), lights.weight[l]};
    }
    Vec3 sum(0.0f);
    const float* coefficient = p.value;
    for (size_t v = 0; v < 3; ++v) {
      if (p.weight[v] == 0) continue;
      sum += sum_of({rows.data(), count}, p.view[v], coefficient);
      coefficient += ranges_.of(p.view[v]).count();
    }
    return sum;
  }

  /// Sums of the three axes over the components of `view`, whose coefficients begin at `coefficient`.
  Vec3 sum_of(std::span<const WeightedRow> rows, size_t view, const float* coefficient) const {
    Vec3 sum;
    Rows of_axis;
    for (int a = 0; a < 3; ++a) {
      const ComponentRanges::Range range = ranges_.of(view, static_cast<size_t>(a));
      for (size_t r = 0; r < rows.size(); ++r) of_axis[r] = {rows[r].row + range.begin, rows[r].weight};
      sum[a] = weighted_dot(coefficient, {of_axis.data(), rows.size()}, range.count());
      coefficient += range.count();
    }
    return sum;
  }

  const float* function(uint64_t row) const { return function_.data() + row * btf_->components(); }

  std::shared_ptr<const FactoredBtf> btf_;
  PairInterpolation between_;
  ComponentRanges ranges_;
  bool two_sided_, by_view_;
  std::vector<float> function_;                  // [pair or light][component]
  std::vector<std::vector<float>> texel_value_;  // a level: [texel][component]
};

}  // namespace

std::shared_ptr<const Material> make_factored_material(std::shared_ptr<const FactoredBtf> btf, BtfLight light) {
  return std::make_shared<FactoredMaterial>(std::move(btf), light);
}

}  // namespace velour
