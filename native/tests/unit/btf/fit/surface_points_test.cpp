#include "btf/fit/relief_pyramid.h"

#include <gtest/gtest.h>

#include "btf/fit/srbf/srbf_fit.h"
#include "support/example_srbf.h"
#include "support/striped_btf.h"

namespace velour::surface_points_test {
namespace {

const TexelGrid kStripedGrid{8, 6};

Relief plane(float height) { return {8, 6, std::vector<float>(48, height), 0.75f}; }

/// Waves along x that hide parts of themselves at grazing views.
Relief waves() {
  std::vector<float> heights;
  for (int t = 0; t < 48; ++t) heights.push_back(0.15f * std::sin(2 * kPi * static_cast<float>(t % 8) / 8));
  return {8, 6, heights, 0.75f};
}

std::vector<SurfacePoint> points_of(const BtfMeasurement& btf, const Relief& relief,
                                    const SurfacePointOptions& options) {
  Progress progress;
  CompandedViews views(btf, Companding::none, 1, progress);
  return surface_points(views, btf.grid(), sides_of(btf.layout()).at(0), relief, options, progress);
}

test::MemoryBtf uniform(const Rgb& f) {
  return {test::ringed_layout(), kStripedGrid, [f](auto&&...) { return f; }};
}

TEST(SidesOf, AreFourForDirectionsOnBothSides) {
  const auto sides = sides_of(test::ringed_layout(true));
  ASSERT_EQ(sides.size(), 4u);
  EXPECT_FALSE(sides[0].view_below || sides[0].light_below);
  for (const SideDirections& side : sides) {
    EXPECT_EQ(side.view.size(), 14u);
    EXPECT_EQ(side.light.size(), 15u);
    for (const auto* set : {&side.view, &side.light}) {
      for (const Vec3& w : *set) EXPECT_GT(w.z, 0.0f);
    }
    const Vec3 view = unit_direction(test::ringed_layout(true).views()[side.view_number[3]]);
    EXPECT_EQ(view.z < 0, side.view_below);
    EXPECT_EQ(side.view[3], Vec3(view.x, view.y, std::abs(view.z)));
  }
  EXPECT_EQ(sides_of(test::ringed_layout()).size(), 1u);
}

TEST(SideViews, AreFilteredFromLevelToLevel) {
  const test::MemoryBtf btf = test::striped_btf(kStripedGrid);
  Progress progress;
  CompandedViews views(btf, Companding::none, 1, progress);
  const SideDirections side = sides_of(btf.layout()).at(0);
  std::vector<LevelImages> images;
  read_side_view(views, kStripedGrid, side, 2, 4, images);
  const Eigen::RowVectorXf mean = images[0].value[1].colwise().mean();
  EXPECT_EQ(images[3].width, 1u);
  EXPECT_LT((images[3].value[1].row(0) - mean).norm(), 1e-4f * mean.norm());
  const Rgb expected = test::striped({.wl = side.light[4], .wv = side.view[2]}, 3, 1);
  EXPECT_NEAR(images[0].value[1](11, 4), expected.g, 1e-3f);
}

/// From a plane no view hides anything, and every view shows each place at all lights.
TEST(SurfacePoints, OfAPlaneAreSeenByEveryView) {
  for (const float height : {0.0f, 0.3f}) {
    const auto points =
        points_of(uniform({0.25f, 0.5f, 1}), plane(height), {.points = 20, .pairs = 1000000, .seed = 1});
    ASSERT_EQ(points.size(), 20u);
    for (const SurfacePoint& point : points) {
      EXPECT_EQ(point.pair.size(), 14u * 15);
      EXPECT_EQ(point.to_normal, Mat3(1.0f));
      for (size_t a = 0; a < 3; ++a) {
        for (const float value : point.value[a]) EXPECT_NEAR(value, 0.25f * static_cast<float>(1 << a), 1e-5f);
      }
    }
  }
}

TEST(SurfacePoints, ThatAreHiddenHaveFewerPairs) {
  size_t least = 1000, most = 0;
  for (const SurfacePoint& point :
       points_of(uniform(Rgb(1.0f)), waves(), {.points = 60, .pairs = 1000000, .seed = 1})) {
    least = std::min(least, point.pair.size());
    most = std::max(most, point.pair.size());
  }
  EXPECT_GE(most, 13u * 15);
  EXPECT_LT(least, 12u * 15);
}

TEST(SurfacePoints, HaveAboutAsManyPairsAsAskedFor) {
  double sum = 0;
  for (const SurfacePoint& point : points_of(uniform(Rgb(1.0f)), plane(0), {.points = 50, .pairs = 40, .seed = 2})) {
    sum += static_cast<double>(point.pair.size()) / 50;
  }
  EXPECT_NEAR(sum, 40, 4);
}

/// Places and pairs are a function of the seed.
TEST(SurfacePoints, AreThoseOfTheirSeed) {
  const SurfacePointOptions options{.points = 5, .pairs = 40, .seed = 3};
  const auto one = points_of(uniform(Rgb(1.0f)), plane(0), options),
             two = points_of(uniform(Rgb(1.0f)), plane(0), options);
  const auto other = points_of(uniform(Rgb(1.0f)), plane(0), {.points = 5, .pairs = 40, .seed = 4});
  for (size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(one[i].place, two[i].place);
    EXPECT_EQ(one[i].value, two[i].value);
    EXPECT_NE(one[i].place, other[i].place);
  }
}

TEST(SharedLobes, ShareTheCoefficientsOut) {
  const test::MemoryBtf btf = test::striped_btf(kStripedGrid);
  const auto points = points_of(btf, plane(0), {.points = 24, .pairs = 1000, .seed = 1});
  Progress progress;
  const LobeOrder order = order_lobes(points, {.most = 20, .seed = 1, .threads = 2}, progress);
  SharedLobes shared = chosen_lobes(order, 14, 1);
  refine_lobes(points, order.share(14), {.steps = 3, .threads = 2}, shared, progress);
  EXPECT_EQ(shared.lobe[0].size(), shared.lobes.size());
  EXPECT_EQ(shared.lobe[0].size() + shared.lobe[1].size() + shared.lobe[2].size(), 14u);
  EXPECT_LE(shared.tile_lobes, shared.lobes.size());
  for (const auto& axis : shared.lobe) {
    for (const uint16_t lobe : axis) EXPECT_LT(lobe, shared.lobes.size());
  }
}

TEST(SharedLobes, OfBlackPointsAreTheConstant) {
  const auto points = points_of(uniform(Rgb(0.0f)), plane(0), {.points = 24, .pairs = 100, .seed = 1});
  Progress progress;
  const LobeOrder order = order_lobes(points, {.most = 8, .seed = 1, .threads = 2}, progress);
  SharedLobes shared = chosen_lobes(order, 8, 1);
  refine_lobes(points, order.share(8), {.steps = 3, .threads = 2}, shared, progress);
  EXPECT_EQ(shared.lobes.size(), 1u);
  EXPECT_EQ(shared.lobe[0].size(), 1u);
}

}  // namespace
}  // namespace velour::surface_points_test
