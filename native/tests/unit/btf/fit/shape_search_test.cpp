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

}  // namespace
}  // namespace velour::shape_search_test
