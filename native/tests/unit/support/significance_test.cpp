#include "support/significance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace velour::test {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

TEST(ChiSquareTail, AgreesWithTables) {
  EXPECT_NEAR(chi_square_tail(3.841458820694124, 1), 0.05, 1e-12);
  EXPECT_NEAR(chi_square_tail(23.209251158954356, 10), 0.01, 1e-12);
  EXPECT_NEAR(chi_square_tail(2.0, 2), std::exp(-1.0), 1e-14);
  EXPECT_NEAR(chi_square_tail(30.0, 2) / std::exp(-15.0), 1, 1e-12);
  EXPECT_NEAR(chi_square_tail(4.0, 4), 3 * std::exp(-2.0), 1e-14);
  EXPECT_EQ(chi_square_tail(0, 5), 1);
  EXPECT_NEAR(chi_square_tail(2000, 2000), 0.4957947, 1e-6);  // just below one half: the median is below the mean
}

TEST(StudentTail, AgreesWithClosedForms) {
  for (const double t : {0.0, 0.3, 2.0, 40.0}) {
    // One degree of freedom is the Cauchy distribution; two have t / sqrt(2 + t^2).
    EXPECT_NEAR(student_tail(t, 1), 1 - 2 / std::acos(-1.0) * std::atan(t), 1e-14) << t;
    EXPECT_NEAR(student_tail(-t, 2), 1 - t / std::sqrt(2 + t * t), 1e-14) << t;
    EXPECT_NEAR(student_tail(t, 1e7), student_tail(t, kInfinite), 1e-6) << t;
  }
  EXPECT_NEAR(student_tail(1.959963984540054, kInfinite), 0.05, 1e-14);
  EXPECT_NEAR(student_tail(2.085963447265837, 20), 0.05, 1e-12);
  EXPECT_NEAR(student_tail(12, 20) / 1.3e-10, 1, 0.1);  // far out, where tests of long lists are decided
}

TEST(StudentTail, QuantileInvertsIt) {
  for (const double degrees : {3.0, 20.0, kInfinite}) {
    for (const double p : {0.5, 0.01, 1e-6}) {
      EXPECT_NEAR(student_tail(student_quantile(p, degrees), degrees) / p, 1, 1e-9) << degrees << ' ' << p;
    }
  }
}

TEST(Sidak, GivesTheWholeListItsLevel) {
  EXPECT_NEAR(1 - std::pow(1 - sidak_level(0.01, 50), 50), 0.01, 1e-14);
  EXPECT_DOUBLE_EQ(sidak_level(0.01, 1), 0.01);
}

class Suite : public ::testing::TestWithParam<int> {};

TEST_P(Suite, IsOneList) {
  EXPECT_EQ(suite_level(), sidak_level(0.01, 3));
  EXPECT_EQ(seed_of_test(), seed_of_test());
}

INSTANTIATE_TEST_SUITE_P(Three, Suite, ::testing::Values(1, 2, 3));

}  // namespace
}  // namespace velour::test
