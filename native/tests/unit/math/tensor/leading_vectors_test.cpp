#include "math/tensor/decompositions.h"

#include <gtest/gtest.h>

#include "math/tensor/tensor_view.h"
#include "support/random_tensor.h"
#include "support/singular_values.h"

namespace velour::leading_vectors_test {
namespace {

/// How much of the square of a matrix lies in the span of orthonormal columns.
double kept(const DenseTensor& matrix, const RowMatrix& basis) {
  return mode_product(matrix.view(), 0, basis.transpose(), 2, Progress()).squared_norm();
}

Eigen::VectorXd exact_squares(const DenseTensor& matrix) {
  const Eigen::MatrixXd m =
      Eigen::Map<const RowMatrix>(matrix.data.data(), matrix.extent[0], matrix.extent[1]).cast<double>();
  return test::singular_values(m).array().square();
}

/// Singular values that fall as those of images do: 1 / (1 + i).
DenseTensor falling(Index rows, Index columns, uint64_t seed) {
  const Index rank = std::min<Index>({rows, columns, 60});
  RowMatrix left = orthonormal(test::random_matrix(rows, rank, seed));
  for (Index i = 0; i < rank; ++i) left.col(i) /= static_cast<float>(1 + i);
  const RowMatrix product = left * orthonormal(test::random_matrix(columns, rank, seed + 1)).transpose();
  DenseTensor matrix({rows, columns});
  std::copy_n(product.data(), product.size(), matrix.data.begin());
  return matrix;
}

TEST(LeadingVectors, KeepWhatTheExactOnesDo) {
  // Products on the left, on the right, and a random range.
  for (const auto& [rows, columns] : {std::pair<Index, Index>{40, 90}, {1100, 30}, {1100, 1030}}) {
    const DenseTensor matrix = falling(rows, columns, 3);
    const RowMatrix basis = leading_vectors(matrix.view(), 0, 8, {}, Progress());
    EXPECT_EQ(basis.cols(), 8);
    EXPECT_LT(test::orthonormality_error(basis), 1e-5f);
    double exact = 0;
    for (Index i = 0; i < 8; ++i) exact += 1 / static_cast<double>((1 + i) * (1 + i));
    EXPECT_NEAR(kept(matrix, basis), exact, 2e-5 * exact) << rows << " x " << columns;
    // The strongest first.
    EXPECT_NEAR(kept(matrix, basis.leftCols(1)), 1, 1e-3);
  }
}

TEST(LeadingVectors, OfAModeInTheMiddleAreThoseOfItsUnfolding) {
  const DenseTensor tensor = test::random_tensor({6, 7, 5}, 8);
  const DenseTensor matrix = [&] {
    DenseTensor m = copied(tensor.view().permuted({1, 0, 2}));
    m.extent = {7, 30};
    return m;
  }();
  const RowMatrix basis = leading_vectors(tensor.view(), 1, 3, {}, Progress());
  EXPECT_NEAR(kept(matrix, basis), exact_squares(matrix).head(3).sum(), 1e-4);
}

TEST(LeadingVectors, BeyondTheRankAreStillOrthonormal) {
  const DenseTensor matrix = test::random_tucker({1200, 4}, {2, 2}, 5);
  const RowMatrix basis = leading_vectors(matrix.view(), 0, 6, {}, Progress());
  EXPECT_LT(test::orthonormality_error(basis), 1e-5f);
  EXPECT_NEAR(kept(matrix, basis), matrix.squared_norm(), 1e-5 * matrix.squared_norm());
}

TEST(RandomRange, NeedsPowersWhereValuesFallSlowly) {
  const DenseTensor matrix = test::random_tensor({300, 400}, 6);
  const double exact = exact_squares(matrix).head(20).sum();
  const auto share = [&](int powers) {
    const RowMatrix basis = random_range(matrix.view(), 0, 20, powers, {.seed = 2}, Progress());
    EXPECT_LT(test::orthonormality_error(basis), 1e-5f);
    return kept(matrix, basis) / exact;
  };
  const double none = share(0), some = share(6);
  EXPECT_LT(none, 0.6);
  EXPECT_GT(some, 0.9);
  EXPECT_LE(some, 1 + 1e-5);
}

}  // namespace
}  // namespace velour::leading_vectors_test
