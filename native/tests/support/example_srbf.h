// A small BTF of multivariate SRBFs with every field set to something that is not its default, and what it means.
#pragma once

#include <cmath>

#include "btf/measure/relief.h"
#include "btf/model/srbf_btf.h"
#include "image/texels.h"

namespace velour::test {

inline std::vector<HalfBits> waving_halves(size_t count, float mean, float swing, float phase) {
  std::vector<float> floats(count);
  for (size_t i = 0; i < count; ++i) floats[i] = mean + swing * std::sin(phase + 1.7f * static_cast<float>(i));
  std::vector<HalfBits> bits(count);
  floats_to_halves(floats, bits);
  return bits;
}

/// Bytes without an order.
inline std::vector<uint8_t> waving_bytes(size_t count, float phase) {
  std::vector<uint8_t> bytes(count);
  for (size_t i = 0; i < count; ++i) {
    bytes[i] = static_cast<uint8_t>(127.5f + 127.5f * std::sin(phase + 1.7f * static_cast<float>(i)));
  }
  return bytes;
}

/// Five lobes, two of them in the frame of the normal, eight coefficients, over a relief of a tenth of the tile.
inline SrbfSide example_side(uint32_t width, uint32_t height, bool below) {
  SrbfSide side{below, below, {}, 3, {}, {}, {}};
  const float other = below ? 0.6f : 1.0f;
  side.lobes = {{},
                {Vec3(1.5f, 0.5f, 2.0f) * other, Vec3(0.0f), Vec3(0.0f)},
                {Vec3(-1.0f, 0.0f, 1.0f), Vec3(0.5f, 0.5f, 1.0f), Vec3(0.0f), 0.6f},
                {Vec3(0.0f), Vec3(0.0f), Vec3(0.0f, 0.5f, 12.0f) * other},
                {Vec3(0.0f, 2.0f, 3.0f), Vec3(0.0f), Vec3(0.0f, 0.0f, 4.0f), -0.2f}};
  side.lobe = {{{0, 1, 2, 3, 4}, {3, 1}, {4}}};
  for (size_t k = 0; k < side.coefficients(); ++k) {
    const auto swing = 0.001f * static_cast<float>(k);
    side.scale.push_back({0.06f - swing, (0.38f + 2 * swing) / 255});
  }
  for (;; width = half_of(width), height = half_of(height)) {
    const size_t texels = size_t{width} * height;
    side.levels.push_back({width, height, waving_halves(texels, 0.01f, width > 1 ? 0.05f : 0.0f, 0.5f),
                           waving_bytes(texels * side.coefficients(), below ? 0.9f : 0.1f)});
    if (width == 1 && height == 1) return side;
  }
}

/// 6 x 4 texels; views and lights on one side, or on both.
inline SrbfBtf example_srbf(bool two_sided = false, Companding companding = Companding::root) {
  std::vector<PolarAngles> views = ring_directions(30, 5), lights = ring_directions(50, 6);
  views.push_back({0, 0});
  if (two_sided) {
    for (const PolarAngles& d : below(views)) views.push_back(d);
    for (const PolarAngles& d : below(lights)) lights.push_back(d);
  }
  SrbfBtf btf{PairLayout(views, lights), {6, 4, Vec2(0.002f, 0.003f)}, companding, Mat3(1.0f), {}};
  btf.axes = Mat3(Vec3(0.8f, 0.6f, 0.0f), Vec3(-0.6f, 0.8f, 0.0f), Vec3(0.0f, 0.0f, 1.0f));
  btf.sides.push_back(example_side(6, 4, false));
  if (two_sided) btf.sides.push_back(example_side(6, 4, true));
  return btf;
}

inline double lobe_value(const MultivariateLobe& lobe, const LobeArguments& at) {
  double exponent =
      static_cast<double>(lobe.phase) * static_cast<double>(at.phase) - static_cast<double>(std::abs(lobe.phase));
  for (const auto& [v, w] : {std::pair(lobe.light, at.wl), {lobe.view, at.wv}, {lobe.half, at.half}}) {
    exponent += glm::dot(Vec3d(v), Vec3d(w)) - glm::length(Vec3d(v));
  }
  return std::exp(exponent);
}

inline Relief relief_of(const SrbfBtf& btf, const SrbfLevel& level) {
  std::vector<float> heights(level.relief.size());
  halves_to_floats(level.relief, heights);
  return {level.width, level.height, heights, tile_aspect(btf.grid)};
}

/// f by the definition in btf/model/srbf_btf.h: of a side, at a place of a level, for directions with z > 0.
inline Rgb defined_value(const SrbfBtf& btf, const SrbfSide& side, size_t level, const Vec2& uv,
                         const DirectionPair& pair) {
  const SrbfLevel& of = side.levels[level];
  const Relief relief = relief_of(btf, of);
  const BilinearTexels texels = bilinear_texels(relief.seen(uv, pair.wv), of.width, of.height);
  Vec2 slope(0.0f);
  for (size_t i = 0; i < 4; ++i) {
    slope += texels.weight[i] * relief.slope(texels.index[i] % of.width, texels.index[i] / of.width);
  }
  const LobeArguments tile(pair), turned = tile.turned(to_normal(slope));
  Vec3d sum(0.0);
  size_t k = 0;
  for (int a = 0; a < 3; ++a) {
    for (const uint16_t j : side.lobe[static_cast<size_t>(a)]) {
      double value = 0;
      for (size_t i = 0; i < 4; ++i) {
        const uint8_t byte = of.value[texels.index[i] * side.coefficients() + k];
        const ByteScale& scale = side.scale[k];
        value += static_cast<double>(texels.weight[i]) *
                 (static_cast<double>(scale.least) + static_cast<double>(scale.step) * byte);
      }
      sum[a] += value * lobe_value(side.lobes[j], j < side.tile_lobes ? tile : turned);
      ++k;
    }
  }
  const Vec3 color = btf.axes * Vec3(sum);
  return {expanded(btf.companding, color.r), expanded(btf.companding, color.g), expanded(btf.companding, color.b)};
}

}  // namespace velour::test
