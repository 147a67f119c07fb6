#include "btf/fit/svd/svd_fit.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "unit/btf/fit/factored_fits.h"

namespace velour::factored_fit_test {
namespace {

using test::fit;
using test::kGrid;
using test::noise;
using test::small_layout;

/// What both decompositions promise.
template <class Fitter>
class FactoredFit : public testing::Test {};
using Fitters = testing::Types<SvdFitter, ViewSvdFitter>;
TYPED_TEST_SUITE(FactoredFit, Fitters);

TYPED_TEST(FactoredFit, CoarseLevelsKeepTheMeanOfWhatIsSquared) {
  const test::MemoryBtf btf(small_layout(), {8, 8}, [](const DirectionPair&, uint32_t x, uint32_t y) {
    return Rgb((x + y) % 2 == 0 ? 0.8f : 0.0f);
  });
  const test::FactoredFit found = fit<TypeParam>(btf, {.bytes = 2000});
  ASSERT_EQ(found.btf.levels.size(), 4u);
  FactoredBtf coarse = found.btf;
  coarse.levels = {found.btf.levels[1]};
  coarse.grid = {4, 4};
  std::vector<float> image;
  FactoredImages(coarse).image(btf.layout().directions(3), image);
  for (const float f : image) EXPECT_NEAR(f, 0.4f, 2e-3f);  // filtered coefficients would give 0.2
}

TYPED_TEST(FactoredFit, KeepsToItsBytes) {
  const test::MemoryBtf btf(small_layout(), kGrid, noise);
  EXPECT_LE(fit<TypeParam>(btf, {.bytes = 3000}).btf.parameter_bytes(), 3000u);
  EXPECT_THROW(fit<TypeParam>(btf, {.bytes = 100}), Error);
  EXPECT_THROW(fit<TypeParam>(btf, {.bytes = 3000, .memory = 1000}), Error);
}

TYPED_TEST(FactoredFit, IsTheSameForAnyNumberOfThreads) {
  const test::MemoryBtf btf(small_layout(), kGrid, noise);
  const test::FactoredFit one = fit<TypeParam>(btf, {.bytes = 9000, .threads = 1}),
                          two = fit<TypeParam>(btf, {.bytes = 9000, .threads = 2});
  EXPECT_EQ(one.btf.pair_value, two.btf.pair_value);
  EXPECT_EQ(one.btf.levels[0].value, two.btf.levels[0].value);
}

TYPED_TEST(FactoredFit, NeedsEveryPair) {
  const PairLayout holes(ring_directions(30, 2), ring_directions(50, 2), {{0, 1}, {0}});
  EXPECT_THROW(fit<TypeParam>(test::MemoryBtf(holes, kGrid, noise), {}), Error);
}

}  // namespace
}  // namespace velour::factored_fit_test
