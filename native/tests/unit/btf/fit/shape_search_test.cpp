#include "btf/fit/tensor/shape_search.h"

#include <gtest/gtest.h>

#include "support/random_tensor.h"

namespace velour::shape_search_test {
namespace {

/// 3 functions of 12 views and 12 lights, none of which is simpler than that.
FoundShape found(uint32_t functions) {
  const DenseTensor slices = test::random_tucker({200, 12, 12, 3}, {3, 12, 12, 1}, 7);
  TensorExtent extent{.texels = 100, .finest = 100, .views = 12, .lights = 12, .view_rank = 12, .light_rank = 12};
  extent.functions = functions;
  Progress progress;
  return search_shape(slices.view(), {.range = {}, .extent = extent, .bytes = 2000, .seed = 1, .threads = 1}, progress);
}

TEST(ShapeSearch, GivesTexelsNoMoreThanTheyNeed) {
  const FoundShape shape = found(640);
  EXPECT_LE(shape.best.shape.rank.texel, 4u);
  EXPECT_LT(shape.best.error, 0.7 * shape.trials[0].expected);
}

TEST(ShapeSearch, GoesOnWhereSharesMakeTheSameShape) {
  const FoundShape shape = found(8);  // from a share of 0.48 on texels have 8 coefficients
  EXPECT_EQ(shape.trials[0].rank[0], 8u);
  EXPECT_LE(shape.best.shape.rank.texel, 4u);
  EXPECT_LT(shape.best.error, 0.7 * shape.trials[0].expected);
}

/// Files and evaluators refuse larger ones.
TEST(ShapeSearch, RanksFitTheStorageOfAllClusters) {
  const TensorExtent extent{
      .texels = 87381, .finest = 65536, .views = 105, .lights = 105, .view_rank = 105, .light_rank = 105};
  const auto largest = [&](uint32_t clusters) { return largest_shape({clusters, 1, 3, 0.3}, extent, 1 << 26).value(); };
  for (const uint32_t clusters : {65u, 128u, 256u}) {
    const TensorSide::Ranks rank = largest(clusters).rank;
    for (const uint32_t each : {rank.texel, rank.light}) {
      EXPECT_LE(clusters * padded_rank(each), TensorBtf::kMaxClusterRanks) << clusters;
    }
  }
  EXPECT_GT(largest(8).rank.light, 64u) << "the control: few clusters have larger ranks";
}

}  // namespace
}  // namespace velour::shape_search_test
