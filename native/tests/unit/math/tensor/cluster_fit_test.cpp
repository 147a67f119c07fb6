#include "math/tensor/cluster_fit.h"

#include <gtest/gtest.h>

#include <numeric>

#include "base/error.h"
#include "math/tensor/cluster_choice.h"
#include "math/tensor/decompositions.h"
#include "support/random_tensor.h"

namespace velour::cluster_fit_test {
namespace {

const std::vector<Index> kExtents{120, 9, 7, 3}, kRanks{2, 4, 3, 2};

ClusterFit fit(const DenseTensor& tensor, const ClusterOptions& options) {
  Progress progress;
  return fit_clusters(tensor.view(), options, progress);
}

/// The best of fits with so many seeds.
ClusterFit best_fit(const DenseTensor& tensor, ClusterOptions options, uint64_t seeds) {
  ClusterFit best;
  for (options.tensor.seed = 0; options.tensor.seed < seeds; ++options.tensor.seed) {
    ClusterFit found = fit(tensor, options);
    if (best.error.empty() || found.error.back() < best.error.back()) best = std::move(found);
  }
  return best;
}

double explicit_error(const ClusterFit& found, const DenseTensor& tensor) {
  return test::squared_distance(expanded(found.tensor, {}, Progress()), tensor);
}

void expect_never_rising(const std::vector<double>& error, double square) {
  for (size_t i = 1; i < error.size(); ++i) EXPECT_LE(error[i], error[i - 1] + 1e-6 * square) << i;
}

/// Slices made of `members` of `clusters` clusters of kRanks each, in turns.
DenseTensor clustered(Index clusters, Index members, uint64_t seed) {
  DenseTensor sum(kExtents);
  const Index size = static_cast<Index>(sum.data.size()) / kExtents[0];
  for (Index c = 0; c < clusters; ++c) {
    const DenseTensor part = test::random_tucker(kExtents, kRanks, seed + 10 * static_cast<uint64_t>(c));
    for (Index i = 0; i < kExtents[0]; ++i) {
      const Index turn = (i + c + i / clusters) % clusters;  // differs from slice to slice
      if (turn >= members) continue;
      for (Index k = 0; k < size; ++k) {
        sum.data[static_cast<size_t>(i * size + k)] += part.data[static_cast<size_t>(i * size + k)];
      }
    }
  }
  return sum;
}

TEST(Clusters, OfOneAreTucker) {
  const DenseTensor tensor = test::random_tensor(kExtents, 1);
  const ClusterFit found = fit(tensor, {.ranks = kRanks, .iterations = 40, .tolerance = 1e-7});
  const Tucker tucker = test::swept_tucker(tensor.view(), kRanks, 40);
  const double error = tensor.squared_norm() - tucker.core.squared_norm();
  EXPECT_NEAR(found.error.back(), error, 1e-3 * error);
  EXPECT_NEAR(explicit_error(found, tensor), found.error.back(), 1e-4 * error);
}

TEST(Clusters, AreRecovered) {
  const DenseTensor tensor = clustered(4, 1, 3);
  const ClusterFit found = best_fit(tensor, {.clusters = 4, .ranks = kRanks}, 3);
  EXPECT_LT(found.error.back(), 1e-6 * found.square);
  // The control: three do not do.
  EXPECT_GT(best_fit(tensor, {.clusters = 3, .ranks = kRanks}, 3).error.back(), 1e-2 * found.square);
}

TEST(Clusters, OfNoiseNeverGetWorse) {
  const DenseTensor tensor = test::random_tensor(kExtents, 4);
  for (const Index members : {1, 2, 3}) {
    const ClusterFit found = fit(tensor, {.clusters = 5, .members = members, .ranks = kRanks, .tolerance = 0});
    EXPECT_GT(found.error.size(), 20u);
    expect_never_rising(found.error, found.square);
    EXPECT_NEAR(explicit_error(found, tensor), found.error.back(), 1e-4 * found.square);
  }
}

TEST(Clusters, OfMoreMembersAreCloser) {
  const DenseTensor tensor = test::random_tensor(kExtents, 5);
  double before = 2 * tensor.squared_norm();
  for (const Index members : {1, 2, 3, 4}) {
    const double error = fit(tensor, {.clusters = 4, .members = members, .ranks = kRanks}).error.back();
    EXPECT_LT(error, before) << members;
    before = error;
  }
}

TEST(Clusters, OfSparseSumsAreRecovered) {
  const DenseTensor tensor = clustered(4, 2, 7);
  const ClusterOptions options{.clusters = 4, .members = 2, .ranks = kRanks, .iterations = 200, .tolerance = 1e-9};
  const ClusterFit found = best_fit(tensor, options, 8);
  EXPECT_LT(found.error.back(), 1e-4 * found.square);
  ClusterOptions one = options;
  one.members = 1;
  EXPECT_GT(best_fit(tensor, one, 8).error.back(), 1e-2 * found.square) << "the control";
}

TEST(Clusters, OfTheSameSlicesAreFilledAgain) {
  // All slices alike: k-means leaves clusters empty.
  DenseTensor tensor = test::random_tensor(kExtents, 7);
  const size_t size = tensor.data.size() / static_cast<size_t>(kExtents[0]);
  for (size_t i = size; i < tensor.data.size(); ++i) tensor.data[i] = tensor.data[i % size];
  const ClusterFit found = fit(tensor, {.clusters = 3, .ranks = {1, 9, 7, 3}});
  EXPECT_LT(found.error.back(), 1e-6 * found.square);
}

TEST(Clusters, AreTheSameForAnyNumberOfThreads) {
  const DenseTensor tensor = test::random_tensor(kExtents, 8);
  const auto of = [&](int threads) {
    return fit(tensor, {.clusters = 4, .members = 2, .ranks = kRanks, .iterations = 3, .tensor = {.threads = threads}});
  };
  const ClusterFit one = of(1), two = of(2);
  EXPECT_EQ(one.error, two.error);
  EXPECT_EQ(one.tensor.member, two.tensor.member);
  EXPECT_EQ(one.tensor.coefficient, two.tensor.coefficient);
}

TEST(Clusters, StopWhenTheyAreCancelled) {
  const DenseTensor tensor = test::random_tensor(kExtents, 9);
  Progress progress;
  progress.cancel();
  EXPECT_THROW(fit_clusters(tensor.view(), {.clusters = 2, .ranks = kRanks}, progress), Error);
}

TEST(Clusters, RefuseCountsThatDoNotFit) {
  const DenseTensor tensor = test::random_tensor({6, 4, 4}, 10);
  for (const ClusterOptions& wrong :
       {ClusterOptions{.ranks = {2, 2}}, {.clusters = 2, .members = 3, .ranks = {2, 2, 2}}, {.ranks = {5, 2, 2}}}) {
    EXPECT_THROW(fit(tensor, wrong), Error);
  }
}

TEST(ClusterChoice, TellsTheErrorWithoutTheSlice) {
  const DenseTensor tensor = test::random_tensor({10, 40}, 11);
  std::vector<RowMatrix> basis;
  for (uint64_t c = 0; c < 3; ++c) basis.push_back(orthonormal(test::random_matrix(40, 4, 20 + c)).transpose());
  const ClusterProducts products(tensor.view(), basis, {}, Progress());
  for (Index i = 0; i < 10; ++i) {
    const Eigen::Map<const Eigen::RowVectorXf> slice(tensor.data.data() + i * 40, 40);
    for (Index c = 0; c < 3; ++c) {
      const RowMatrix& b = basis[static_cast<size_t>(c)];
      const double error = static_cast<double>((slice - slice * b.transpose() * b).squaredNorm());
      EXPECT_NEAR(static_cast<double>(slice.squaredNorm()) - products.kept(i, c), error, 1e-5);
    }
    const std::vector<uint32_t> both{0, 2};
    Eigen::RowVectorXf coefficient(8);
    const double kept = products.solve(i, both, coefficient);
    const Eigen::RowVectorXf rest = slice - coefficient.head(4) * basis[0] - coefficient.tail(4) * basis[2];
    EXPECT_NEAR(static_cast<double>(slice.squaredNorm()) - kept, static_cast<double>(rest.squaredNorm()), 1e-4);
  }
}

TEST(ClusterChoice, BearsBlocksThatOverlap) {
  const DenseTensor tensor = test::random_tensor({5, 30}, 12);
  const RowMatrix same = orthonormal(test::random_matrix(30, 3, 13)).transpose();
  const ClusterProducts products(tensor.view(), {same, same}, {}, Progress());
  ClusteredTensor choice;
  choice.members = 2;
  const double kept = choose_members(products, choice, {}, Progress()).after;
  double expected = 0;
  for (Index i = 0; i < 5; ++i) expected += products.kept(i, 0);
  EXPECT_NEAR(kept, expected, 1e-3 * expected);
}

}  // namespace
}  // namespace velour::cluster_fit_test
