#include "btf/factored_btf.h"

#include "btf/pair_interpolation.h"

namespace velour {

uint64_t FactoredBtf::parameter_bytes() const {
  uint64_t values = pair_value.size();
  for (const TexelLevel& level : levels) values += level.value.size();
  return values * sizeof(HalfBits);
}

uint64_t pyramid_texels(const TexelGrid& grid) {
  uint32_t width = grid.width, height = grid.height;
  uint64_t sum = uint64_t{width} * height;
  while (width > 1 || height > 1) {
    width = half_of(width);
    height = half_of(height);
    sum += uint64_t{width} * height;
  }
  return sum;
}

struct FactoredImages::Impl {
  const FactoredBtf& btf;
  PairInterpolation between;
  std::vector<float> pair_value, texel_value;  // [pair][component], [texel][component]

  /// The functions of the pair, by component; false where there are none.
  bool components_at(const DirectionPair& pair, std::vector<float>& sums) const {
    const auto view = between.view(pair.wv), light = between.light(pair.wl);
    sums.assign(btf.components(), 0.0f);
    if (!view || !light) return false;
    for (size_t v = 0; v < 3; ++v) {
      for (size_t l = 0; l < 3; ++l) {
        const float weight = view->weight[v] * light->weight[l];
        if (weight == 0) continue;
        const float* row = pair_value.data() + (btf.layout.first(view->index[v]) + light->index[l]) * sums.size();
        for (size_t k = 0; k < sums.size(); ++k) sums[k] += weight * row[k];
      }
    }
    return true;
  }
};

FactoredImages::FactoredImages(const FactoredBtf& btf) {
  auto impl = std::make_unique<Impl>(Impl{btf, PairInterpolation(btf.layout), {}, {}});
  impl->pair_value.resize(btf.pair_value.size());
  impl->texel_value.resize(btf.levels.at(0).value.size());
  halves_to_floats(btf.pair_value, impl->pair_value);
  halves_to_floats(btf.levels[0].value, impl->texel_value);
  impl_ = std::move(impl);
}

FactoredImages::~FactoredImages() = default;

void FactoredImages::image(const DirectionPair& pair, std::vector<float>& rgb) const {
  const FactoredBtf& btf = impl_->btf;
  rgb.assign(btf.grid.texels() * 3, 0.0f);
  std::vector<float> function;
  if (!impl_->components_at(pair, function)) return;
  const size_t components = function.size();
  for (uint64_t texel = 0; texel < btf.grid.texels(); ++texel) {
    Vec3 sum(0.0f);
    const float* value = impl_->texel_value.data() + texel * components;
    for (size_t k = 0; k < components; ++k) sum[btf.axis[k]] += value[k] * function[k];
    const Vec3 color = btf.axes * sum;
    for (int c = 0; c < 3; ++c) rgb[texel * 3 + static_cast<size_t>(c)] = expanded(btf.companding, color[c]);
  }
}

}  // namespace velour
