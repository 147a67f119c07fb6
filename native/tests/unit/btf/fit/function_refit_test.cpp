#include "btf/fit/tensor/function_refit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "math/tensor/decompositions.h"

namespace velour::function_refit_test {
namespace {

constexpr Index kViews = 9, kLights = 11, kRefitTexels = 60, kClusters = 3, kRank = 4, kViewRank = 3, kLightRank = 5,
                kColors = 2;

RowMatrix orthonormal_rows(Index rows, Index columns) { return orthonormal(RowMatrix::Random(rows, columns)); }

std::vector<DirectionCluster> random_clusters(unsigned seed) {
  std::srand(seed);  // Eigen draws from it
  std::vector<DirectionCluster> clusters;
  for (Index c = 0; c < kClusters; ++c) {
    clusters.push_back({orthonormal_rows(kViews, kViewRank), orthonormal_rows(kLights, kLightRank),
                        orthonormal_rows(3, kColors), RowMatrix::Random(kRank * kViewRank, kLightRank * kColors)});
  }
  return clusters;
}

/// Moments of images that `truth` makes from random coefficients, which differ from view to view as over a relief.
std::vector<ViewMoments> moments_of(const std::vector<DirectionCluster>& truth, float noise = 0) {
  std::vector<ViewMoments> moments;
  for (Index v = 0; v < kViews; ++v) {
    const RowMatrix seen = RowMatrix::Random(kRefitTexels, kClusters * kRank);
    const FunctionsOfView functions = functions_of_view(truth, v);
    ViewMoments& of = moments.emplace_back(kClusters * kRank, kLights);
    of.products = seen.transpose() * seen;
    for (size_t a = 0; a < 3; ++a) {
      const RowMatrix images = seen * functions[a] + noise * RowMatrix::Random(kRefitTexels, kLights);
      of.images[a] = seen.transpose() * images;
    }
  }
  return moments;
}

/// Relative L2 distance between the functions of `a` and of `b`.
double distance(const std::vector<DirectionCluster>& a, const std::vector<DirectionCluster>& b) {
  double difference = 0, all = 0;
  for (Index v = 0; v < kViews; ++v) {
    const FunctionsOfView one = functions_of_view(a, v), two = functions_of_view(b, v);
    for (size_t axis = 0; axis < 3; ++axis) {
      difference += static_cast<double>((one[axis] - two[axis]).squaredNorm());
      all += static_cast<double>(two[axis].squaredNorm());
    }
  }
  return std::sqrt(difference / all);
}

TEST(FunctionRefit, FindsTheCoresThatImagesWereMadeOf) {
  const auto truth = random_clusters(1);
  auto clusters = truth;
  for (DirectionCluster& c : clusters) c.core += 0.3f * RowMatrix::Random(c.core.rows(), c.core.cols());
  ASSERT_GT(distance(clusters, truth), 0.1);
  refit_cores(moments_of(truth), 2, Progress(), clusters);
  EXPECT_LT(distance(clusters, truth), 1e-3);
}

TEST(FunctionRefit, FindsFactorsThatHaveMoved) {
  const auto truth = random_clusters(2);
  auto clusters = truth;
  for (DirectionCluster& c : clusters) {
    c.view += 0.1f * RowMatrix::Random(kViews, kViewRank);
    c.light += 0.1f * RowMatrix::Random(kLights, kLightRank);
  }
  const double before = distance(clusters, truth);
  refit_functions(moments_of(truth), {.rounds = 8, .threads = 2}, Progress(), clusters);
  EXPECT_LT(distance(clusters, truth), 0.02 * before);
}

TEST(FunctionRefit, NeverRaisesTheErrorAndLeavesFactorsOrthonormal) {
  const auto truth = random_clusters(3);
  for (const float noise : {0.0f, 0.5f}) {
    auto clusters = random_clusters(4);
    const std::vector<double> value = refit_functions(moments_of(truth, noise), {3, 2}, Progress(), clusters);
    for (size_t i = 1; i < value.size(); ++i) {
      EXPECT_LE(value[i], value[i - 1] + 1e-4 * std::abs(value[0])) << i;
    }
    EXPECT_LT(value.back(), 0.8 * value.front()) << "the control: it moved; values are below 0";
    for (const DirectionCluster& c : clusters) {
      EXPECT_LT((c.view.transpose() * c.view - RowMatrix::Identity(kViewRank, kViewRank)).norm(), 1e-5f);
      EXPECT_LT((c.light.transpose() * c.light - RowMatrix::Identity(kLightRank, kLightRank)).norm(), 1e-5f);
    }
  }
}

TEST(FunctionRefit, IsTheSameForAnyNumberOfThreads) {
  const auto moments = moments_of(random_clusters(5), 0.1f);
  auto one = random_clusters(6), two = one;
  refit_functions(moments, {2, 1}, Progress(), one);
  refit_functions(moments, {2, 3}, Progress(), two);
  for (size_t c = 0; c < one.size(); ++c) {
    EXPECT_EQ(one[c].core, two[c].core);
    EXPECT_EQ(one[c].view, two[c].view);
    EXPECT_EQ(one[c].light, two[c].light);
  }
}

/// Nothing can be determined from a cluster without texels, nor from black images.
TEST(FunctionRefit, LeavesWhatNobodySeesFinite) {
  auto moments = moments_of(random_clusters(7));
  for (ViewMoments& of : moments) {
    of.products.bottomRows(kRank).setZero();
    of.products.rightCols(kRank).setZero();
    for (RowMatrix& image : of.images) image.bottomRows(kRank).setZero();
  }
  auto clusters = random_clusters(8);
  refit_functions(moments, {}, Progress(), clusters);
  for (const DirectionCluster& c : clusters) {
    EXPECT_TRUE(c.view.allFinite() && c.light.allFinite() && c.core.allFinite());
  }
  const std::vector<ViewMoments> black(kViews, ViewMoments(kClusters * kRank, kLights));
  refit_functions(black, {}, Progress(), clusters);
  EXPECT_TRUE(clusters[0].core.allFinite());
}

}  // namespace
}  // namespace velour::function_refit_test
