// A small BTF of SRBFs whose texels all differ.
#pragma once

#include "btf/model/srbf_btf.h"
#include "support/example_btf.h"

namespace velour::test {

/// Two lobes in either frame over a wavy relief; each level has numbers of its own.
inline SrbfBtf sized_srbf(TexelGrid grid) {
  grid.tile_metres = Vec2(0.004f, 0.004f * static_cast<float>(grid.height) / static_cast<float>(grid.width));
  SrbfBtf btf{example_factored().layout, grid, Companding::root, Mat3(1.0f), {}};
  SrbfSide& side = btf.sides.emplace_back();
  side.lobes = {{Vec3(0.0f), Vec3(0.0f), Vec3(0.0f)},
                {Vec3(0.3f, 0.1f, 1.0f), Vec3(0.0f), Vec3(0.0f)},
                {Vec3(0.0f), Vec3(0.0f), Vec3(0.0f, 0.0f, 4.0f)},
                {Vec3(0.5f, 0.0f, 0.5f), Vec3(0.2f, 0.0f, 0.3f), Vec3(0.0f)}};
  side.tile_lobes = 2;
  side.lobe = {{{0, 1, 2, 3}, {0, 2}, {1}}};
  const auto halves = [](size_t count, float phase, float middle, float swing) {
    std::vector<float> floats(count);
    for (size_t i = 0; i < count; ++i) floats[i] = middle + swing * std::sin(phase + 1.7f * static_cast<float>(i));
    std::vector<HalfBits> bits(count);
    floats_to_halves(floats, bits);
    return bits;
  };
  side.scale.assign(side.coefficients(), {0.1f, 0.6f / 255});
  for (uint32_t width = grid.width, height = grid.height;; width = half_of(width), height = half_of(height)) {
    const size_t texels = size_t{width} * height;
    const auto phase = static_cast<float>(width);
    SrbfLevel& level = side.levels.emplace_back(SrbfLevel{width, height, halves(texels, phase, 0.0f, 0.01f), {}});
    for (size_t i = 0; i < texels * side.coefficients(); ++i) {
      const float wave = std::sin(phase + 1.7f * static_cast<float>(i));
      level.value.push_back(static_cast<uint8_t>(127.5f + 127.5f * wave));
    }
    if (width == 1 && height == 1) return btf;
  }
}

}  // namespace velour::test
