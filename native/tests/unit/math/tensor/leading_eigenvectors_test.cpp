#include "math/tensor/decompositions.h"

#include <gtest/gtest.h>

#include "support/random_tensor.h"

namespace velour::leading_eigenvectors_test {
namespace {

constexpr Index kSide = 400, kRank = 12;

/// A symmetric matrix with these eigenvalues.
Eigen::MatrixXd symmetric(const Eigen::VectorXd& value) {
  const Eigen::MatrixXd random = test::random_matrix(value.size(), value.size(), 4).cast<double>();
  const Eigen::MatrixXd q = orthonormal_doubles(random);
  return q * value.asDiagonal() * q.transpose();
}

Eigen::VectorXd falling(double power) { return Eigen::VectorXd::LinSpaced(kSide, 1, kSide).array().pow(-power); }

Eigen::VectorXd rayleigh(const Eigen::MatrixXd& m, const Eigen::MatrixXd& vectors) {
  return (vectors.transpose() * m * vectors).diagonal();
}

double orthonormality_error(const Eigen::MatrixXd& m) {
  return (m.transpose() * m - Eigen::MatrixXd::Identity(m.cols(), m.cols())).cwiseAbs().maxCoeff();
}

TEST(LeadingEigenvectors, HaveTheLargestEigenvaluesInOrder) {
  // Those of images, of shallow ones, and of noise, for which a space would have to be too large.
  for (const double power : {2.0, 0.7, 0.0}) {
    Eigen::VectorXd value = falling(power);
    if (power == 0.0) value = Eigen::VectorXd::LinSpaced(kSide, 1.0, 0.9);
    const Eigen::MatrixXd m = symmetric(value), found = leading_eigenvectors(m, kRank, {}, Progress());
    ASSERT_EQ(found.cols(), kRank);
    EXPECT_LT(orthonormality_error(found), 1e-9);
    EXPECT_LT((rayleigh(m, found) - value.head(kRank)).cwiseAbs().maxCoeff(), 1e-9) << power;
    EXPECT_LT((m * found - found * value.head(kRank).asDiagonal()).colwise().norm().maxCoeff(), 2e-7) << power;
  }
}

TEST(LeadingEigenvectors, OfEqualEigenvaluesAreAnyOfTheirSpace) {
  Eigen::VectorXd value = Eigen::VectorXd::Zero(kSide);
  value.head(30).setOnes();
  const Eigen::MatrixXd m = symmetric(value), found = leading_eigenvectors(m, kRank, {}, Progress());
  EXPECT_LT(orthonormality_error(found), 1e-9);
  EXPECT_LT((m * found - found).norm(), 1e-6);
}

TEST(LeadingEigenvectors, BeyondTheRankAreOrthonormal) {
  Eigen::VectorXd value = Eigen::VectorXd::Zero(kSide);
  for (const Index rank : {0, 1, 5}) {
    value.head(rank).setOnes();
    const Eigen::MatrixXd m = symmetric(value), found = leading_eigenvectors(m, kRank, {}, Progress());
    EXPECT_LT(orthonormality_error(found), 1e-9);
    EXPECT_NEAR(rayleigh(m, found).sum(), static_cast<double>(rank), 1e-9);
  }
}

TEST(LeadingEigenvectors, AreTheSameForAnyNumberOfThreads) {
  const Eigen::MatrixXd m = symmetric(falling(1.0));
  EXPECT_EQ(leading_eigenvectors(m, kRank, {.seed = 3, .threads = 1}, Progress()),
            leading_eigenvectors(m, kRank, {.seed = 3, .threads = 2}, Progress()));
}

}  // namespace
}  // namespace velour::leading_eigenvectors_test
