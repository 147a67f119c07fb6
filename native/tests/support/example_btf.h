// A small factored BTF with every field set to something that is not its default.
#pragma once

#include <cmath>

#include "btf/model/factored_btf.h"

namespace velour::test {

/// Components that serve a view each: of view v, v % 4 of axis 0 and one of axis 2; the last view has none.
inline void serve_views(FactoredBtf& btf) {
  btf.axis.clear();
  for (uint16_t v = 0; v + 1u < btf.layout.views().size(); ++v) {
    for (int k = 0; k < v % 4; ++k) btf.axis.push_back(0);
    btf.axis.push_back(2);
    btf.view.resize(btf.axis.size(), v);
  }
}

/// Five components over two axes, or components of views; 6 x 4 texels; views and lights on one side, or on both.
inline FactoredBtf example_factored(bool two_sided = false, Companding companding = Companding::root,
                                    bool by_view = false) {
  std::vector<PolarAngles> views = ring_directions(30, 5), lights = ring_directions(50, 6);
  views.push_back({0, 0});
  if (two_sided) {
    for (const PolarAngles& d : below(views)) views.push_back(d);
    for (const PolarAngles& d : below(lights)) lights.push_back(d);
  }
  FactoredBtf btf{PairLayout(views, lights), {6, 4, Vec2(0.002f, 0.003f)}, companding, {}, {0, 0, 0, 2, 2}, {}, {}};
  btf.axes = Mat3(Vec3(0.8f, 0.6f, 0.0f), Vec3(-0.6f, 0.8f, 0.0f), Vec3(0.0f, 0.0f, 1.0f));
  const auto halves = [](size_t count, float phase) {
    std::vector<float> floats(count);
    for (size_t i = 0; i < count; ++i) floats[i] = 0.4f + 0.3f * std::sin(phase + 1.7f * static_cast<float>(i));
    std::vector<HalfBits> bits(count);
    floats_to_halves(floats, bits);
    return bits;
  };
  if (by_view) serve_views(btf);
  btf.pair_value = halves(btf.function_rows() * btf.components(), 0.1f);
  for (uint32_t width = 6, height = 4;; width = half_of(width), height = half_of(height)) {
    btf.levels.push_back({width, height, halves(size_t{width} * height * btf.components(), 0.3f)});
    if (width == 1 && height == 1) return btf;
  }
}

}  // namespace velour::test
