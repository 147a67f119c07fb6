#include "btf/eval/factored_material.h"

#include <algorithm>
#include <array>

#include "btf/eval/measured_btf_material.h"
#include "btf/measure/pair_layout.h"
#include "btf/model/factored_btf.h"
#include "material/surface_site.h"

namespace velour {
namespace {

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

  const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                              ScratchArena& arena) const override;

  Vec2 texels() const override { return Vec2(btf_->grid.width, btf_->grid.height); }

 private:
  friend class PreparedFactored;

  const float* function(uint64_t row) const { return function_.data() + row * btf_->components(); }

  std::shared_ptr<const FactoredBtf> btf_;
  PairInterpolation between_;
  ComponentRanges ranges_;
  bool two_sided_, by_view_;
  std::vector<float> function_;                  // [pair or light][component]
  std::vector<std::vector<float>> texel_value_;  // a level: [texel][component]
};

/// The coefficients of the components, interpolated between texels, and the views around the direction of view.
class PreparedFactored final : public PreparedCosineBtf {
 public:
  PreparedFactored(const FactoredMaterial& material, const Vec3& wv, const SurfaceSite& site, ScratchArena& arena)
      : m_(material), back_(site.back && material.two_sided_) {
    const auto views = m_.between_.view(m_.turned(wv, back_));
    if (!views) return;
    weight_ = views->weight;
    view_ = views->index;
    const uint32_t count = m_.by_view_ ? components_of_views() : static_cast<uint32_t>(m_.btf_->components());
    value_ = arena.make_array<float>(count + kFactoredSlack).data();
    std::fill_n(value_, count, 0.0f);
    visit_texels(site, m_.btf_->levels, [&](size_t level, uint64_t texel, float share) {
      add_texel(m_.texel_value_[level].data() + texel * m_.btf_->components(), share);
    });
  }

 private:
  using Rows = std::array<WeightedRow, 9>;

  uint32_t components_of_views() const {
    uint32_t count = 0;
    for (size_t v = 0; v < 3; ++v) count += weight_[v] == 0 ? 0 : m_.ranges_.of(view_[v]).count();
    return count;
  }

  /// Adds a texel's coefficients: those of all components, or of each view one after the other, times its weight.
  void add_texel(const float* row, float share) {
    if (!m_.by_view_) return add_weighted({row, share}, static_cast<uint32_t>(m_.btf_->components()), value_);
    float* sum = value_;
    for (size_t v = 0; v < 3; ++v) {
      if (weight_[v] == 0) continue;
      const ComponentRanges::Range range = m_.ranges_.of(view_[v]);
      add_weighted({row + range.begin, share * weight_[v]}, range.count(), sum);
      sum += range.count();
    }
  }

  Rgb value(const Vec3& wl) const override {
    if (!(wl.z > 0) || weight_[0] + weight_[1] + weight_[2] == 0) return Rgb(0.0f);
    const auto lights = m_.between_.light(m_.turned_light(wl, back_));
    if (!lights) return Rgb(0.0f);
    const Vec3 color = m_.btf_->axes * (m_.by_view_ ? sum_by_view(*lights) : sum_of_pairs(*lights));
    return {expanded(m_.btf_->companding, color.r), expanded(m_.btf_->companding, color.g),
            expanded(m_.btf_->companding, color.b)};
  }

  /// Components that serve all views: nine functions of direction pairs.
  Vec3 sum_of_pairs(const PairInterpolation::Corners& lights) const {
    Rows rows;
    size_t count = 0;
    for (size_t v = 0; v < 3; ++v) {
      const uint64_t first = m_.btf_->layout.first(view_[v]);
      for (size_t l = 0; l < 3; ++l) {
        const float weight = weight_[v] * lights.weight[l];
        if (weight > 0) rows[count++] = {m_.function(first + lights.index[l]), weight};
      }
    }
    return sum_of({rows.data(), count}, view_[0], value_);
  }

  /// Components that serve one view each: three functions of lights for each view.
  Vec3 sum_by_view(const PairInterpolation::Corners& lights) const {
    Rows rows;
    size_t count = 0;
    for (size_t l = 0; l < 3; ++l) {
      if (lights.weight[l] > 0) rows[count++] = {m_.function(lights.index[l]), lights.weight[l]};
    }
    Vec3 sum(0.0f);
    const float* coefficient = value_;
    for (size_t v = 0; v < 3; ++v) {
      if (weight_[v] == 0) continue;
      sum += sum_of({rows.data(), count}, view_[v], coefficient);
      coefficient += m_.ranges_.of(view_[v]).count();
    }
    return sum;
  }

  /// Sums of the three axes over the components of `view`, whose coefficients begin at `coefficient`.
  Vec3 sum_of(std::span<const WeightedRow> rows, size_t view, const float* coefficient) const {
    Vec3 sum;
    Rows of_axis;
    for (int a = 0; a < 3; ++a) {
      const ComponentRanges::Range range = m_.ranges_.of(view, static_cast<size_t>(a));
      for (size_t r = 0; r < rows.size(); ++r) of_axis[r] = {rows[r].row + range.begin, rows[r].weight};
      sum[a] = weighted_dot(coefficient, {of_axis.data(), rows.size()}, range.count());
      coefficient += range.count();
    }
    return sum;
  }

  const FactoredMaterial& m_;
  bool back_;                       // seen from below, in a BTF of two sides
  std::array<uint32_t, 3> view_{};  // numbers of views
  std::array<float, 3> weight_{};   // barycentric; 0 everywhere: the BTF has no view on this side
  float* value_ = nullptr;          // of all components, or of those of each view in turn, times its weight
};

const PreparedBrdf* FactoredMaterial::prepare(const Vec3& wv, const SurfaceSite& site,
                                              const PrepareOptions& /*options*/, ScratchArena& arena) const {
  return arena.make<PreparedFactored>(*this, wv, site, arena);
}

}  // namespace

std::shared_ptr<const Material> make_factored_material(std::shared_ptr<const FactoredBtf> btf, BtfLight light) {
  return std::make_shared<FactoredMaterial>(std::move(btf), light);
}

}  // namespace velour
