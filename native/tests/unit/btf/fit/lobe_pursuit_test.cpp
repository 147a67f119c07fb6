#include "btf/fit/srbf/lobe_order.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <set>

#include "math/sphere/random.h"
#include "math/sphere/warp.h"

namespace velour::lobe_pursuit_test {
namespace {

struct PursuitPoint {
  RowMatrix column;  // pair x candidate
  Eigen::VectorXf value;
};

constexpr Eigen::Index kPairs = 60, kCandidates = 40;
const std::set<size_t> kTrue{4, 17, 30};

/// Random columns, and values that are sums of three of them with coefficients of their own plus noise.
std::vector<PursuitPoint> sparse_points(float noise) {
  std::vector<PursuitPoint> points(12);
  for (size_t i = 0; i < points.size(); ++i) {
    RandomStream random(8, i, 0);
    const auto number = [&] { return random.next() - 0.5f; };
    points[i].column = RowMatrix::NullaryExpr(kPairs, kCandidates, number);
    points[i].value = noise * Eigen::VectorXf::NullaryExpr(kPairs, number);
    for (const size_t k : kTrue) {
      points[i].value += (1 + random.next()) * points[i].column.col(static_cast<Eigen::Index>(k));
    }
  }
  return points;
}

PursuitChoice choice_of(const std::vector<PursuitPoint>& points, size_t count, int threads = 2) {
  std::vector<RowMatrix> columns;
  std::vector<Eigen::VectorXf> values;
  for (const PursuitPoint& point : points) {
    columns.push_back(point.column);
    values.push_back(point.value);
  }
  return pursue(columns, values, count, threads, Progress());
}

TEST(LobePursuit, FindsWhatValuesAreMadeOf) {
  const PursuitChoice choice = choice_of(sparse_points(0), 3);
  EXPECT_EQ(std::set<size_t>(choice.order.begin(), choice.order.end()), kTrue);
  EXPECT_LT(choice.left[2], 1e-9 * choice.all);
  EXPECT_GT(choice.left[1], 1e-2 * choice.all);  // the control: two of them are not enough
}

TEST(LobePursuit, LeavesLessWithEveryCandidate) {
  const PursuitChoice choice = choice_of(sparse_points(1), 20);
  ASSERT_EQ(choice.order.size(), 20u);
  EXPECT_EQ(std::set<size_t>(choice.order.begin(), choice.order.end()).size(), 20u);
  double before = choice.all;
  for (const double left : choice.left) {
    EXPECT_LT(left, before);
    before = left;
  }
}

/// A gap of a relief may be hidden from all views.
TEST(LobePursuit, IsNotDisturbedByPointsWithoutPairs) {
  auto points = sparse_points(1);
  const PursuitChoice alone = choice_of(points, 8);
  points.insert(points.begin(), {RowMatrix(0, kCandidates), Eigen::VectorXf(0)});
  const PursuitChoice choice = choice_of(points, 8);
  EXPECT_EQ(choice.order, alone.order);
  EXPECT_EQ(choice.left, alone.left);
}

/// What is left is what least squares leave.
TEST(LobePursuit, ProjectsOntoAllThatWasChosen) {
  const auto points = sparse_points(1);
  const PursuitChoice choice = choice_of(points, 8);
  double expected = 0;
  for (const PursuitPoint& point : points) {
    Eigen::MatrixXd column(kPairs, 8);
    for (Eigen::Index k = 0; k < 8; ++k) {
      const auto chosen = static_cast<Eigen::Index>(choice.order[static_cast<size_t>(k)]);
      column.col(k) = point.column.col(chosen).cast<double>();
    }
    const Eigen::VectorXd value = point.value.cast<double>();
    expected += (value - column * column.householderQr().solve(value)).squaredNorm();
  }
  EXPECT_NEAR(choice.left[7], expected, 1e-4 * expected);
}

TEST(LobePursuit, StopsWhereNothingIsLeft) {
  auto points = sparse_points(0);
  for (PursuitPoint& point : points) point.value.setZero();
  EXPECT_TRUE(choice_of(points, 5).order.empty());
  EXPECT_TRUE(choice_of({}, 5).order.empty());
}

TEST(LobePursuit, PassesColumnsOfZeros) {
  auto points = sparse_points(0.1f);
  for (PursuitPoint& point : points) point.column.leftCols(10).setZero();
  for (const size_t k : choice_of(points, 6).order) EXPECT_GE(k, 10u);
}

/// Points with random values at random pairs, the same number of pairs each.
std::vector<SurfacePoint> points_of_pairs(size_t pairs) {
  std::vector<SurfacePoint> points(8);
  for (size_t i = 0; i < points.size(); ++i) {
    RandomStream random(9, i, 0);
    points[i].to_normal = Mat3(1.0f);
    for (size_t pair = 0; pair < pairs; ++pair) {
      const Vec3 wl = sample_cosine_hemisphere(random.next2());
      points[i].pair.emplace_back(DirectionPair{wl, sample_cosine_hemisphere(random.next2())});
      for (auto& axis : points[i].value) axis.push_back(random.next());
    }
  }
  return points;
}

TEST(OrderLobes, TakesNoMoreLobesThanThereArePairs) {
  for (const size_t pairs : {1, 6}) {
    Progress progress;
    const LobeOrder order = order_lobes(points_of_pairs(pairs), {.most = 100, .threads = 2}, progress);
    for (const auto& candidates : order.candidate) EXPECT_LE(candidates.size(), pairs);
    EXPECT_GE(order.candidate[0].size(), 1u);
  }
}

TEST(LobePursuit, IsTheSameForAnyNumberOfThreads) {
  const PursuitChoice one = choice_of(sparse_points(1), 10, 1), two = choice_of(sparse_points(1), 10, 2);
  EXPECT_EQ(one.order, two.order);
  EXPECT_EQ(one.left, two.left);
}

}  // namespace
}  // namespace velour::lobe_pursuit_test
