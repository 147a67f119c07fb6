#include "btf/model/factored_btf.h"

#include <algorithm>
#include "btf/measure/pair_layout.h"

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
  ComponentRanges ranges;
  std::vector<float> pair_value, texel_value;  // [row of functions][component], [texel][component]

  /// Values of the pair functions by component, and the groups of components that are not all 0.
  struct Functions {
    std::vector<float> value;
    std::vector<size_t> group;
  };
  Functions functions_at(const DirectionPair& pair) const {
    Functions found{std::vector<float>(btf.components(), 0.0f), {}};
    const auto view = between.view(pair.wv), light = between.light(pair.wl);
    if (!view || !light) return found;
    for (size_t v = 0; v < 3; ++v) {
      if (view->weight[v] == 0) continue;
      const size_t group = ranges.groups() > 1 ? view->index[v] : 0;
      if (std::find(found.group.begin(), found.group.end(), group) == found.group.end()) found.group.push_back(group);
      for (size_t l = 0; l < 3; ++l) {
        add_row(view->index[v], light->index[l], view->weight[v] * light->weight[l], found.value);
      }
    }
    return found;
  }

  void add_row(size_t view, uint32_t light, float weight, std::vector<float>& sums) const {
    if (weight == 0) return;
    const float* row = pair_value.data() + (btf.first_row(view) + light) * btf.components();
    const auto [begin, end] = ranges.of(view);
    for (uint32_t k = begin; k < end; ++k) sums[k] += weight * row[k];
  }
};

FactoredImages::FactoredImages(const FactoredBtf& btf) {
  auto impl = std::make_unique<Impl>(Impl{btf, PairInterpolation(btf.layout), ComponentRanges(btf), {}, {}});
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
  const Impl::Functions functions = impl_->functions_at(pair);
  if (functions.group.empty()) return;
  for (uint64_t texel = 0; texel < btf.grid.texels(); ++texel) {
    Vec3 sum(0.0f);
    const float* value = impl_->texel_value.data() + texel * btf.components();
    for (const size_t group : functions.group) {
      const auto [begin, end] = impl_->ranges.of(group);
      for (uint32_t k = begin; k < end; ++k) sum[btf.axis[k]] += value[k] * functions.value[k];
    }
    const Vec3 color = btf.axes * sum;
    for (int c = 0; c < 3; ++c) rgb[texel * 3 + static_cast<size_t>(c)] = expanded(btf.companding, color[c]);
  }
}

ComponentRanges::ComponentRanges(const FactoredBtf& btf) {
  const size_t groups = btf.by_view() ? btf.layout.views().size() : 1;
  uint32_t at = 0;
  const auto number = [](size_t k) { return static_cast<uint32_t>(k); };
  for (size_t group = 0; group < groups; ++group) {
    Bounds& bounds = bounds_.emplace_back();
    for (size_t a = 0; a < 3; ++a) {
      bounds[a] = at;
      while (at < number(btf.components()) && btf.axis[at] == a && (!btf.by_view() || btf.view[at] == group)) ++at;
    }
    bounds[3] = at;
  }
}

}  // namespace velour
