#include "math/optimize/nnls.h"

#include <gtest/gtest.h>

#include "math/sphere/random.h"

namespace velour::nnls_test {
namespace {

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, uint64_t seed) {
  RandomStream random(seed, 0, 0);
  Eigen::MatrixXd m(rows, columns);
  for (Eigen::Index i = 0; i < m.size(); ++i) m.data()[i] = 2.0 * random.next() - 1.0;
  return m;
}

/// Karush, Kuhn, Tucker: x >= 0, slope = 0 where x > 0, slope <= 0 where x = 0.
void expect_optimal(const Eigen::MatrixXd& gram, const Eigen::VectorXd& moment, const Eigen::VectorXd& x) {
  const Eigen::VectorXd slope = moment - gram * x;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    EXPECT_GE(x[i], 0);
    if (x[i] > 0) {
      EXPECT_NEAR(slope[i], 0, 1e-8) << i;
    } else {
      EXPECT_LE(slope[i], 1e-8) << i;
    }
  }
}

TEST(Nnls, MeetsTheOptimalityConditions) {
  for (uint64_t seed = 0; seed < 50; ++seed) {
    const Eigen::MatrixXd a = random_matrix(40, 12, seed);
    const Eigen::MatrixXd gram = a.transpose() * a;
    const Eigen::VectorXd moment = a.transpose() * random_matrix(40, 1, seed + 1000);
    Eigen::VectorXd x;
    solve_nnls(gram, moment, 0, x);
    expect_optimal(gram, moment, x);
  }
}

TEST(Nnls, AWarmStartDoesNotChangeTheSolution) {
  const Eigen::MatrixXd a = random_matrix(40, 12, 7);
  const Eigen::MatrixXd gram = a.transpose() * a;
  const Eigen::VectorXd moment = a.transpose() * random_matrix(40, 1, 8);
  Eigen::VectorXd cold, warm = Eigen::VectorXd::Ones(12);
  solve_nnls(gram, moment, 0, cold);
  solve_nnls(gram, moment, 0, warm);
  EXPECT_LT((cold - warm).norm(), 1e-10);
}

TEST(Nnls, EqualColumnsShareTheWork) {
  Eigen::MatrixXd gram = Eigen::MatrixXd::Ones(2, 2);
  const Eigen::VectorXd moment = Eigen::VectorXd::Constant(2, 3.0);
  Eigen::VectorXd x;
  solve_nnls(gram, moment, 1e-7, x);
  EXPECT_NEAR(x.sum(), 3.0, 1e-5);
  EXPECT_GE(x.minCoeff(), 0);
}

TEST(Nnls, NothingToGainGivesZero) {
  Eigen::VectorXd x;
  solve_nnls(Eigen::MatrixXd::Identity(3, 3), Eigen::VectorXd::Constant(3, -1.0), 0, x);
  EXPECT_EQ(x, Eigen::VectorXd::Zero(3));
}

}  // namespace
}  // namespace velour::nnls_test
