#include "btf/fit/seen_texels.h"

#include <gtest/gtest.h>

#include "btf/fit/tensor/tensor_texels.h"
#include "support/example_tensor.h"

namespace velour::shown_views_test {
namespace {

constexpr uint32_t kWidth = 12, kShownTexels = kWidth * kWidth;

/// Walls along y, and what lies between them: columns 4 ... 7.
Relief walls() {
  std::vector<float> heights;
  for (uint32_t t = 0; t < kShownTexels; ++t) heights.push_back(t % kWidth < 4 || t % kWidth > 7 ? 0.6f : 0.0f);
  return {kWidth, kWidth, heights, 1};
}

bool between_walls(size_t texel) { return texel % kWidth == 5 || texel % kWidth == 6; }

/// Seen along the normal, and over the walls from a side and a little lower.
struct Tile {
  TexelGrid grid{kWidth, kWidth, Vec2(0.01f)};
  SideDirections side{false,
                      false,
                      {0, 1, 2},
                      {0, 1},
                      {Vec3(0, 0, 1), direction(1.2f, 0), direction(1.3f, 0)},
                      {direction(0.5f, 0), direction(0.5f, kPi)}};
  std::vector<Relief> relief{walls()};
  TensorSource source{grid, side, relief, 0, 1};
  Progress progress;
};

/// One cluster of two functions: one is 1 everywhere; the other tells the two lights apart by a little along the
/// normal, and is 3 from the sides.
TensorSide two_functions() {
  TensorSide side{false, false, {2, 3, 2, 1}, 1, {}, {}};
  side.clusters.push_back({.view = test::halves_of({1, 0, 0, 0, 1, 0, 0, 0, 1}),
                           .light = test::halves_of({1, 0, 0, 1}),
                           .color = test::halves_of({1, 0, 0}),
                           .core = test::halves_of({1, 1, 1, 1, 1, 1, 0.05f, -0.05f, 3, 3, 3, 3}),
                           .scale = {}});
  return side;
}

/// 1.1 and 0.9 under the two lights along the normal, 1 from the sides.
LevelImages image_of(Index view) {
  LevelImages images{kWidth, kWidth, {}};
  for (RowMatrix& axis : images.value) axis = RowMatrix::Zero(kShownTexels, 2);
  images.value[0].col(0).setConstant(view == 0 ? 1.1f : 1.0f);
  images.value[0].col(1).setConstant(view == 0 ? 0.9f : 1.0f);
  return images;
}

TEST(ShownViews, TheNearestViewThatShowsATexelStandsInForOneThatHidesIt) {
  const Tile tile;
  const ShownViews shown(tile.source, 0, tile.progress);
  EXPECT_FALSE(shown.all());
  for (size_t t = 0; t < kShownTexels; ++t) {
    EXPECT_EQ(shown.stand_in(t, 0), 0);
    if (between_walls(t) || t % kWidth == 1) {
      EXPECT_EQ(shown.stand_in(t, 2), between_walls(t) ? 0 : 2);
    }
  }
  const ShownViews::Values values = shown.values(2, image_of(2), tile.progress);
  EXPECT_EQ(values[0](1, 0), 1);
  EXPECT_EQ(values[0](5, 0), 0);
}

TEST(ShownViews, OfAPlaneShowAll) {
  Tile tile;
  tile.relief[0] = Relief(kWidth, kWidth, std::vector<float>(kShownTexels, 0.0f), 1);
  EXPECT_TRUE(ShownViews(tile.source, 0, tile.progress).all());
}

/// Texels that a view hides had whatever value there was the least error elsewhere with: here 7 in place of 1. Views
/// between that one and one that shows them had white specks.
TEST(ShownViews, WhatIsHiddenStaysWithinReason) {
  const Tile tile;
  const SeenTexels seen(tile.source, 0, tile.progress);
  const ShownViews shown(tile.source, 0, tile.progress);
  const TensorFunctions functions(two_functions(), 1, tile.progress);
  TensorTexels texels(tile.source, seen, shown, functions, tile.progress);
  std::vector<FunctionsOfView> of_views;
  for (Index v = 0; v < 3; ++v) of_views.push_back(functions.of_view(v));
  for (Index v = 0; v < 3; ++v) texels.add_view(v, image_of(v), of_views);
  const TensorTexelValues values = texels.solve(1, [](double) {});
  for (Index t = 0; t < Index{kShownTexels}; ++t) {
    if (!between_walls(static_cast<size_t>(t))) continue;
    const float hidden = (values.value.row(t) * of_views[2][0].col(0)).value();
    EXPECT_NEAR(hidden, 1, 1) << t;
    const float seen_from_above = (values.value.row(t) * of_views[0][0].col(0)).value();
    EXPECT_NEAR(seen_from_above, 1.1, 0.11) << t;
  }
}

}  // namespace
}  // namespace velour::shown_views_test
