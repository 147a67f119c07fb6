// BTFs that are made of a model, and what tests of their fits ask alike.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "base/error.h"
#include "support/relief_btf.h"

namespace velour::test {

/// f of all texels for a pair, [row][column][channel].
using PairImage = std::function<void(const DirectionPair& pair, std::vector<float>& rgb)>;

/// What `image` shows; asked texel after texel, pair after pair.
inline MemoryBtf shown_by(const PairLayout& layout, const TexelGrid& grid, const PairImage& image) {
  DirectionPair of{Vec3(0.0f), Vec3(0.0f)};
  std::vector<float> rgb;
  return {layout, grid, [&](const DirectionPair& pair, uint32_t x, uint32_t y) {
            if (pair.wl != of.wl || pair.wv != of.wv) image(of = pair, rgb);
            const size_t i = 3 * (size_t{y} * grid.width + x);
            return Rgb(rgb[i], rgb[i + 1], rgb[i + 2]);
          }};
}

/// With heights in widths of the tile; `hole`: the first texel meets nothing.
inline MemoryBtfWithRelief over_relief(MemoryBtf values, std::vector<float> heights, bool hole = false) {
  // Over the lowest point of a shell whose middle is the reference plane, in metres.
  const double width = static_cast<double>(values.grid().tile_metres->x);
  for (float& h : heights) h = static_cast<float>(width * (static_cast<double>(h) + 0.1));
  if (hole) heights[0] = std::numeric_limits<float>::infinity();
  return {std::move(values), heights, {0.2 * width, 0.1 * width}};
}

/// `work` throws such an error, whose sentence holds `part`.
template <class Work>
void expect_refused(Status status, const std::string& part, const Work& work) {
  try {
    work();
    ADD_FAILURE() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), status);
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

}  // namespace velour::test
