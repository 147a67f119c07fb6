#include "math/optimize/lbfgs.h"

#include <gtest/gtest.h>

#include <cmath>

namespace velour::lbfgs_test {
namespace {

using Vector = Eigen::VectorXd;

void nothing(int) {}

double rosenbrock(const Vector& x, Vector& slope) {
  slope.resize(2);
  const double a = 1 - x[0], b = x[1] - x[0] * x[0];
  slope << -2 * a - 400 * x[0] * b, 200 * b;
  return a * a + 100 * b * b;
}

/// Curvatures from 1 to 1000 over ten parameters, lowest at 1.
double valley(const Vector& x, Vector& slope) {
  const Vector curvature = Vector::LinSpaced(x.size(), 0, 3).unaryExpr([](double e) { return std::pow(10, e); });
  const Vector from = x - Vector::Ones(x.size());
  slope = curvature.cwiseProduct(from);
  return 0.5 * from.dot(slope);
}

TEST(Lbfgs, FindsTheBottomOfRosenbrocksValley) {
  const Vector x = descend_lbfgs(rosenbrock, Vector{{-1.2, 1.0}}, {}, nothing);
  EXPECT_NEAR(x[0], 1, 1e-4);
  EXPECT_NEAR(x[1], 1, 1e-4);
}

TEST(Lbfgs, FindsTheBottomOfAQuadratic) {
  const Vector x = descend_lbfgs(valley, Vector::Zero(10), {.settled = 1e-12}, nothing);
  for (const double value : x) EXPECT_NEAR(value, 1, 1e-4);
}

TEST(Lbfgs, IsNeverWorseThanItsStart) {
  // A slope that lies: every step leads upwards, so none is taken.
  const auto lying = [](const Vector& x, Vector& slope) {
    slope = -2 * x;
    return x.squaredNorm();
  };
  const Vector start{{1.0, -2.0, 3.0}};
  EXPECT_EQ(descend_lbfgs(lying, start, {}, nothing), start);
  // One that leads into values that are no numbers.
  const auto cliff = [](const Vector& x, Vector& slope) {
    slope = Vector::Ones(1);
    return x[0] < -0.5 ? std::nan("") : x[0];
  };
  Vector slope;
  const Vector end = descend_lbfgs(cliff, Vector{{0.0}}, {}, nothing);
  EXPECT_LE(cliff(end, slope), 0);
}

TEST(Lbfgs, StaysWhereThereIsNoSlope) {
  int steps = 0;
  const Vector x = descend_lbfgs(valley, Vector::Ones(4), {}, [&](int) { ++steps; });
  EXPECT_EQ(x, Vector::Ones(4));
  EXPECT_EQ(steps, 0);
}

TEST(Lbfgs, CountsItsSteps) {
  std::vector<int> steps;
  descend_lbfgs(rosenbrock, Vector{{-1.2, 1.0}}, {.steps = 5}, [&](int step) { steps.push_back(step); });
  EXPECT_EQ(steps, (std::vector<int>{0, 1, 2, 3, 4}));
}

}  // namespace
}  // namespace velour::lbfgs_test
