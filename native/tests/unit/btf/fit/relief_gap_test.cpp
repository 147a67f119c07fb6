#include "btf/fit/relief_pyramid.h"

#include <gtest/gtest.h>

#include "support/relief_btf.h"
#include "support/striped_btf.h"

namespace velour::relief_gap_test {
namespace {

TexelGrid grid() { return {12, 8, Vec2(0.003f, 0.002f)}; }

/// One color, or stripes, over ridges of `high` widths of the tile.
double share_of(float high, bool striped) {
  std::vector<float> heights;
  const double width = 0.003;
  for (uint32_t t = 0; t < grid().texels(); ++t) {
    const float ridge = high * std::sin(2 * kPi * static_cast<float>(t % 12) / 6);
    heights.push_back(static_cast<float>(width * (static_cast<double>(ridge) + 0.3)));
  }
  const auto f = [&](const DirectionPair& pair, uint32_t x, uint32_t y) {
    return striped ? test::striped(pair, x, y) : Rgb(0.3f);
  };
  const test::MemoryBtfWithRelief btf({test::ringed_layout(), grid(), f}, heights, {0.6 * width, 0.3 * width});
  Progress progress;
  CompandedViews views(btf, Companding::root, 2, progress);
  const SideDirections side = sides_of(btf.layout())[0];
  const std::vector<Relief> relief = relief_pyramid(btf, side);
  const TensorSource source{btf.grid(), side, relief, 0, 2};
  ReliefGap gap(source, 50, progress);
  std::vector<LevelImages> images;
  for (size_t v = 0; v < side.view.size(); ++v) {
    read_side_view(views, btf.grid(), side, v, 1, images);
    gap.add_view(static_cast<Index>(v), images[0]);
  }
  return gap.share();
}

TEST(ReliefGap, IsNothingOnThePlane) { EXPECT_EQ(share_of(0, true), 0); }

/// What looks the same everywhere is put together without a loss.
TEST(ReliefGap, IsNothingWhereAllTexelsLookAlike) { EXPECT_LT(share_of(0.1f, false), 1e-6); }

/// The stripes do not follow the relief at all.
TEST(ReliefGap, GrowsWithWhatTheReliefHides) {
  const double low = share_of(0.01f, true), high = share_of(0.1f, true);
  EXPECT_GT(low, 1e-5);
  EXPECT_GT(high, 2 * low);
  EXPECT_LT(high, 1);
}

}  // namespace
}  // namespace velour::relief_gap_test
