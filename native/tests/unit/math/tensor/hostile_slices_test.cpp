// Where clusters of tensors end: docs/results/failure_modes.md has a line for each of these.
#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <numeric>

#include "base/error.h"
#include "math/tensor/cluster_fit.h"
#include "support/random_tensor.h"
#include "support/singular_values.h"

namespace velour::hostile_slices_test {
namespace {

const std::vector<Index> kExtents{40, 6, 5, 3}, kRanks{2, 3, 3, 2};
constexpr Index kSlice = 6 * 5 * 3;

ClusterFit fit(const DenseTensor& tensor, const ClusterOptions& options) {
  Progress progress;
  ClusterFit found = fit_clusters(tensor.view(), options, progress);
  for (size_t i = 1; i < found.error.size(); ++i) {
    EXPECT_LE(found.error[i], found.error[i - 1] + 1e-6 * found.square) << "the objective rose at " << i;
  }
  for (const TensorCluster& cluster : found.tensor.cluster) {
    EXPECT_TRUE(cluster.core.allFinite());
    for (const RowMatrix& factor : cluster.factor) EXPECT_LT(test::orthonormality_error(factor), 1e-6f);
  }
  EXPECT_TRUE(found.tensor.coefficient.allFinite());
  return found;
}

double error_of(const ClusterFit& found, const DenseTensor& tensor) {
  return test::squared_distance(expanded(found.tensor, {}, Progress()), tensor);
}

/// Slice i is one of as many patterns as `of` has values, scaled by its own number.
DenseTensor patterns(const std::vector<int>& of, uint64_t seed) {
  DenseTensor tensor({static_cast<Index>(of.size()), 6, 5, 3});
  for (size_t i = 0; i < of.size(); ++i) {
    const DenseTensor pattern =
        test::random_tucker({1, 6, 5, 3}, {1, 2, 2, 2}, seed + 100 * static_cast<uint64_t>(of[i]));
    const float scale = 1 + 0.1f * static_cast<float>(i % 7);
    for (size_t k = 0; k < kSlice; ++k) tensor.data[i * kSlice + k] = scale * pattern.data[k];
  }
  return tensor;
}

std::vector<int> by_turns(size_t count, int patterns) {
  std::vector<int> of(count);
  for (size_t i = 0; i < count; ++i) of[i] = static_cast<int>(i) % patterns;
  return of;
}

TEST(HostileSlices, OfZeroAreZero) {
  const DenseTensor zero(kExtents);
  const ClusterFit found = fit(zero, {.clusters = 4, .members = 2, .ranks = kRanks});
  EXPECT_EQ(found.error.back(), 0);
  EXPECT_EQ(error_of(found, zero), 0);
}

TEST(HostileSlices, ThatAreConstantAreExact) {
  DenseTensor constant(kExtents);
  std::fill(constant.data.begin(), constant.data.end(), 0.7f);
  const ClusterFit found = fit(constant, {.clusters = 3, .members = 2, .ranks = kRanks});
  EXPECT_LT(error_of(found, constant), 1e-8 * found.square);
}

TEST(HostileSlices, FewerThanClustersAreExact) {
  const DenseTensor few = test::random_tensor({3, 6, 5, 3}, 1);
  const ClusterFit found = fit(few, {.clusters = 8, .members = 2, .ranks = {2, 6, 5, 3}});
  EXPECT_LT(error_of(found, few), 1e-8 * found.square);
}

TEST(HostileSlices, RanksBeyondTheModesAreThoseOfTheModes) {
  const DenseTensor tensor = test::random_tensor(kExtents, 2);
  const ClusterFit found = fit(tensor, {.clusters = 2, .ranks = {kSlice, 60, 50, 30}});
  EXPECT_EQ(found.tensor.cluster[0].factor[0].cols(), 6);
  EXPECT_LT(error_of(found, tensor), 1e-8 * found.square);
}

/// Two clusters: what is far off has one, or shares it, and the others lose nothing by it.
TEST(HostileSlices, OneOutlierDoesNotSpoilTheOthers) {
  DenseTensor tensor = patterns(by_turns(40, 2), 3);
  const DenseTensor stray = test::random_tensor({1, 6, 5, 3}, 4);
  for (size_t k = 0; k < kSlice; ++k) tensor.data[17 * kSlice + k] = 0.5f * stray.data[k];
  const auto rest = [&](Index clusters) {
    const ClusterFit found = fit(tensor, {.clusters = clusters, .ranks = {1, 2, 2, 2}});
    const DenseTensor made = expanded(found.tensor, {}, Progress());
    double sum = 0;
    for (size_t i = 0; i < tensor.data.size(); ++i) {
      const double d = static_cast<double>(made.data[i] - tensor.data[i]);
      if (i / kSlice != 17) sum += d * d;
    }
    return sum / found.square;
  };
  EXPECT_LT(rest(3), 1e-4);
  EXPECT_GT(rest(1), 1e-2) << "the control";
}

TEST(HostileSlices, ThatAreNoNumbersAreRefusedWithTheirNumber) {
  for (const float wrong : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    DenseTensor tensor = test::random_tensor(kExtents, 5);
    tensor.data[23 * kSlice + 4] = wrong;
    try {
      fit(tensor, {.clusters = 2, .ranks = kRanks});
      ADD_FAILURE() << "not refused";
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), Status::invalid_argument);
      EXPECT_NE(std::string(error.what()).find("Slice 23"), std::string::npos) << error.what();
    }
  }
}

/// Slices whose singular values span eight orders of ten.
TEST(HostileSlices, ThatAreAllButDependentAreBorne) {
  DenseTensor tensor(kExtents);
  for (int rank = 0; rank < 5; ++rank) {
    const DenseTensor part = test::random_tucker(kExtents, {1, 1, 1, 1}, 20 + static_cast<uint64_t>(rank));
    const float scale = std::pow(10.0f, -2.0f * static_cast<float>(rank));
    for (size_t i = 0; i < tensor.data.size(); ++i) tensor.data[i] += scale * part.data[i];
  }
  const ClusterFit found = fit(tensor, {.clusters = 3, .members = 2, .ranks = {4, 4, 4, 3}, .tolerance = 1e-8});
  EXPECT_LT(error_of(found, tensor), 1e-6 * found.square);
}

/// Which slices share a cluster does not depend on their order.
TEST(HostileSlices, InAnotherOrderChangeTheirLabelsAlone) {
  const std::vector<int> of = by_turns(40, 3);
  const DenseTensor tensor = patterns(of, 6);
  std::vector<size_t> order(of.size());
  std::iota(order.begin(), order.end(), size_t{0});
  for (size_t i = 0; i < order.size(); ++i) std::swap(order[i], order[(7 * i + 3) % order.size()]);
  DenseTensor turned(kExtents);
  for (size_t i = 0; i < order.size(); ++i) {
    std::copy_n(tensor.data.begin() + static_cast<ptrdiff_t>(order[i] * kSlice), kSlice,
                turned.data.begin() + static_cast<ptrdiff_t>(i * kSlice));
  }
  const ClusterOptions options{.clusters = 3, .ranks = {1, 2, 2, 2}};
  const ClusterFit one = fit(tensor, options), two = fit(turned, options);
  EXPECT_NEAR(one.error.back(), two.error.back(), 1e-5 * one.square);
  std::map<uint32_t, uint32_t> label;
  for (size_t i = 0; i < order.size(); ++i) {
    const uint32_t before = one.tensor.member[order[i]];
    EXPECT_EQ(label.try_emplace(before, two.tensor.member[i]).first->second, two.tensor.member[i]) << i;
  }
  EXPECT_EQ(label.size(), 3u);
}

/// What floats find is what doubles find: the best rank of a matrix, by an exact decomposition.
TEST(HostileSlices, InFloatsAreAsGoodAsInDoubles) {
  const DenseTensor tensor = test::random_tensor({40, kSlice}, 7);
  const ClusterFit found = fit(tensor, {.ranks = {5, 5}, .tolerance = 1e-9});
  const Eigen::MatrixXd exact = Eigen::Map<const RowMatrix>(tensor.data.data(), 40, kSlice).cast<double>();
  const Eigen::VectorXd values = test::singular_values(exact);
  const double least = values.tail(values.size() - 5).squaredNorm();
  EXPECT_NEAR(found.error.back(), least, 1e-5 * found.square);
  EXPECT_NEAR(error_of(found, tensor), least, 1e-5 * found.square);
}

}  // namespace
}  // namespace velour::hostile_slices_test
