#include "math/tensor/decompositions.h"

#include <gtest/gtest.h>

#include "support/random_tensor.h"

namespace velour::tucker_test {
namespace {

const std::vector<Index> kExtents{9, 8, 3, 10}, kRanks{3, 4, 2, 3};

TEST(Tucker, RecoversATensorOfItsRanks) {
  const DenseTensor tensor = test::random_tucker(kExtents, kRanks, 1);
  const double square = tensor.squared_norm();
  const auto rest = [&](const std::vector<Index>& ranks) {
    const Tucker tucker = truncated_hosvd(tensor.view(), ranks, {}, Progress());
    return test::squared_distance(expanded(tucker, {}, Progress()), tensor) / square;
  };
  EXPECT_LT(rest(kRanks), 1e-10);
  EXPECT_GT(rest({3, 4, 2, 2}), 1e-4) << "the control";
}

TEST(Tucker, HasTheErrorThatItsCoreTells) {
  const DenseTensor tensor = test::random_tensor(kExtents, 2);
  const Tucker tucker = test::swept_tucker(tensor.view(), kRanks, 5);
  for (size_t mode = 0; mode < kRanks.size(); ++mode) {
    EXPECT_EQ(tucker.factor[mode].cols(), kRanks[mode]);
    EXPECT_LT(test::orthonormality_error(tucker.factor[mode]), 1e-5f);
  }
  EXPECT_EQ(tucker.core.extent, kRanks);
  const double told = tensor.squared_norm() - tucker.core.squared_norm();
  EXPECT_NEAR(test::squared_distance(expanded(tucker, {}, Progress()), tensor), told, 1e-4 * told);
}

TEST(Tucker, GetsNoWorseWithSweeps) {
  const DenseTensor tensor = test::random_tensor(kExtents, 3);
  Tucker tucker = truncated_hosvd(tensor.view(), kRanks, {}, Progress());
  const double start = tucker.core.squared_norm();
  double before = start;
  for (int sweep = 0; sweep < 6; ++sweep) {
    hooi_sweep(tensor.view(), tucker, {}, Progress());
    const double now = tucker.core.squared_norm();
    EXPECT_GE(now, before * (1 - 1e-6)) << sweep;
    before = now;
  }
  EXPECT_GT(before, 1.02 * start) << "noise is where iterating pays";
}

TEST(Tucker, OfTheExtentsIsExact) {
  const DenseTensor tensor = test::random_tensor({3, 4, 2}, 4);
  const Tucker tucker = test::swept_tucker(tensor.view(), {3, 4, 2}, 1);
  EXPECT_LT(test::squared_distance(expanded(tucker, {}, Progress()), tensor), 1e-10);
}

TEST(Tucker, IsTheSameForAnyNumberOfThreads) {
  const DenseTensor tensor = test::random_tensor({20, 30, 40}, 5);
  const auto fit = [&](int threads) { return test::swept_tucker(tensor.view(), {3, 4, 5}, 2, {.threads = threads}); };
  const Tucker one = fit(1), two = fit(2);
  EXPECT_EQ(one.core.data, two.core.data);
  for (size_t mode = 0; mode < 3; ++mode) EXPECT_EQ(one.factor[mode], two.factor[mode]);
}

}  // namespace
}  // namespace velour::tucker_test
