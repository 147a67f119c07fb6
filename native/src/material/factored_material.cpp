#include "material/factored_material.h"

#include <algorithm>
#include <cmath>

#include "btf/pair_interpolation.h"
#include "material/cosine_btf_material.h"
#include "material/factored_sums.h"
#include "material/texel_taps.h"
#include "material/view_factored_material.h"

namespace velour {
namespace {

uint32_t padded(size_t count) {
  return static_cast<uint32_t>((count + kFactoredPadding - 1) / kFactoredPadding * kFactoredPadding);
}

class FactoredMaterial final : public CosineBtfMaterial {
 public:
  FactoredMaterial(std::shared_ptr<const FactoredBtf> btf, BtfLight light)
      : CosineBtfMaterial(light), btf_(std::move(btf)), between_(btf_->layout), two_sided_(between_.has_lower_side()) {
    place_components();
    pair_value_.assign(btf_->layout.pairs() * end_[2], 0.0f);
    for (uint64_t pair = 0; pair < btf_->layout.pairs(); ++pair) spread(btf_->pair_value, pair, pair_value_);
    for (const TexelLevel& level : btf_->levels) {
      const uint64_t texels = uint64_t{level.width} * level.height;
      std::vector<float>& values = texel_value_.emplace_back(texels * end_[2], 0.0f);
      for (uint64_t t = 0; t < texels; ++t) spread(level.value, t, values);
    }
  }

  void prepare(const Vec3& wv, const SurfaceSite& site, PreparedBrdf& point) const override {
    point.wv = wv;
    FactoredPoint& p = point.factored;
    p.back = site.back && two_sided_;
    const auto views = between_.view(turned(wv, p.back));
    p.weight = {0, 0, 0};
    if (!views) return;
    p.weight = views->weight;
    for (size_t v = 0; v < 3; ++v) p.view[v] = static_cast<uint32_t>(btf_->layout.first(views->index[v]));
    std::fill_n(p.value, end_[2], 0.0f);
    visit_texels(site, btf_->levels, [&](size_t level, uint64_t texel, float weight) {
      const float* from = texel_value_[level].data() + texel * end_[2];
      for (uint32_t k = 0; k < end_[2]; ++k) p.value[k] += weight * from[k];
    });
  }

  Vec2 texels() const override { return Vec2(btf_->grid.width, btf_->grid.height); }

 private:
  /// Components of an axis are contiguous; each axis starts at a multiple of kFactoredPadding.
  void place_components() {
    uint32_t begin = 0;
    for (uint32_t a = 0; a < 3; ++a) {
      const auto count = static_cast<size_t>(std::count(btf_->axis.begin(), btf_->axis.end(), a));
      for (size_t k = 0; k < count; ++k) place_.push_back(begin + static_cast<uint32_t>(k));
      end_[a] = begin += padded(count);
    }
  }

  /// Copies row `number` of half floats to its padded place in `floats`.
  void spread(const std::vector<HalfBits>& halves, uint64_t number, std::vector<float>& floats) const {
    float row[FactoredBtf::kMaxComponents];
    const size_t components = btf_->components();
    halves_to_floats({halves.data() + number * components, components}, {row, components});
    for (size_t k = 0; k < components; ++k) floats[number * end_[2] + place_[k]] = row[k];
  }

  Rgb value(const PreparedBrdf& point, const Vec3& wl) const override {
    const FactoredPoint& p = point.factored;
    if (!(wl.z > 0) || p.weight[0] + p.weight[1] + p.weight[2] == 0) return Rgb(0.0f);
    const auto lights = between_.light(turned_light(wl, p.back));
    if (!lights) return Rgb(0.0f);
    std::array<WeightedRow, 9> rows;
    size_t count = 0;
    for (size_t v = 0; v < 3; ++v) {
      for (size_t l = 0; l < 3; ++l) {
        const float weight = p.weight[v] * lights->weight[l];
        if (weight > 0)
          rows[count++] = {pair_value_.data() + (uint64_t{p.view[v]} + lights->index[l]) * end_[2], weight};
      }
    }
    const Vec3 color = btf_->axes * factored_sums(p.value, {rows.data(), count}, end_);
    return {expanded(btf_->companding, color.r), expanded(btf_->companding, color.g),
            expanded(btf_->companding, color.b)};
  }

  std::shared_ptr<const FactoredBtf> btf_;
  PairInterpolation between_;
  bool two_sided_;
  std::vector<uint32_t> place_;                  // index of each component in a padded row
  std::array<uint32_t, 3> end_{};                // end of each axis in a padded row
  std::vector<float> pair_value_;                // [pair][padded]
  std::vector<std::vector<float>> texel_value_;  // per level: [texel][padded]
};

}  // namespace

std::shared_ptr<const Material> make_factored_material(std::shared_ptr<const FactoredBtf> btf, BtfLight light) {
  if (btf->by_view()) return make_view_factored_material(std::move(btf), light);
  return std::make_shared<FactoredMaterial>(std::move(btf), light);
}

}  // namespace velour
