#include "math/tensor/matrix_product.h"

#include <gtest/gtest.h>

#include "support/random_tensor.h"

namespace velour::matrix_product_test {
namespace {

/// Room around a matrix, whose rows or columns lie side by side, or neither.
struct Placed {
  std::vector<float> room;
  Index row_stride, column_stride;

  Placed(Index rows, Index columns, int layout)
      : room(static_cast<size_t>(6 * rows * columns + 1), 7.0f),
        row_stride(layout == 0   ? columns
                   : layout == 1 ? 1
                                 : 2 * columns + 1),
        column_stride(layout == 0   ? 1
                      : layout == 1 ? rows + 1
                                    : 2) {}
  StridedMatrix<float> of(Index rows, Index columns) { return {room.data(), rows, columns, row_stride, column_stride}; }
  float& at(Index i, Index j) { return room[static_cast<size_t>(i * row_stride + j * column_stride)]; }
  void set(const RowMatrix& m) {
    for (Index i = 0; i < m.rows(); ++i)
      for (Index j = 0; j < m.cols(); ++j) at(i, j) = m(i, j);
  }
  StridedMatrix<const float> read(Index rows, Index columns) const {
    return {room.data(), rows, columns, row_stride, column_stride};
  }
};

/// Sides below, at and beyond those of tiles and blocks.
struct Sides {
  Index rows, depth, columns;
};
const std::vector<Sides> kSides{{1, 1, 1}, {6, 4, 16}, {7, 3, 33}, {100, 300, 40}, {13, 513, 5}, {97, 20, 130}};

TEST(MatrixProduct, IsItsDefinitionInAnyLayout) {
  for (const auto& [rows, depth, columns] : kSides) {
    const RowMatrix a = test::random_matrix(rows, depth, 1), b = test::random_matrix(depth, columns, 2);
    const Eigen::MatrixXd expected = a.cast<double>() * b.cast<double>();
    for (int layout = 0; layout < 27; ++layout) {
      Placed left(rows, depth, layout % 3), right(depth, columns, layout / 3 % 3), product(rows, columns, layout / 9);
      left.set(a);
      right.set(b);
      const std::vector<float> before = product.room;
      multiply(left.read(rows, depth), right.read(depth, columns), product.of(rows, columns));
      for (Index i = 0; i < rows; ++i) {
        for (Index j = 0; j < columns; ++j) {
          ASSERT_NEAR(product.at(i, j), expected(i, j), 1e-5 * std::sqrt(static_cast<double>(depth)))
              << rows << " x " << depth << " x " << columns << ", layout " << layout;
          product.at(i, j) = 7.0f;
        }
      }
      EXPECT_EQ(product.room, before) << "beside the product";
    }
  }
}

TEST(MatrixProduct, WithAVectorIsThatWithAMatrixOfOneColumn) {
  for (const auto& [rows, depth, unused] : kSides) {
    const RowMatrix a = test::random_matrix(rows, depth, 4), x = test::random_matrix(depth, 1, 5);
    Placed left(rows, depth, 1), product(rows, 1, 1);
    left.set(a);
    const std::vector<float> before = product.room;
    multiply(left.read(rows, depth), x.data(), product.room.data());
    const Eigen::VectorXd expected = a.cast<double>() * x.cast<double>();
    for (Index i = 0; i < rows; ++i) {
      ASSERT_NEAR(product.at(i, 0), expected[i], 1e-5 * std::sqrt(static_cast<double>(depth)))
          << rows << " x " << depth;
      product.at(i, 0) = 7.0f;
    }
    EXPECT_EQ(product.room, before) << "beside the product";
  }
}

TEST(MatrixProduct, OfNothingIsZero) {
  std::vector<float> product(6, 3.0f);
  multiply({nullptr, 2, 0, 0, 1}, {nullptr, 0, 3, 3, 1}, {product.data(), 2, 3, 3, 1});
  EXPECT_EQ(product, std::vector<float>(6, 0.0f));
}

TEST(MatrixProduct, WithItselfIsRightBelowTheDiagonal) {
  for (const auto& [rows, depth, unused] : kSides) {
    const RowMatrix a = test::random_matrix(rows, depth, 3);
    const Eigen::MatrixXd expected = a.cast<double>() * a.cast<double>().transpose();
    RowMatrix product(rows, rows);
    multiply_by_itself({a.data(), rows, depth, depth, 1}, {product.data(), rows, rows, rows, 1});
    const Eigen::MatrixXd error = product.cast<double>() - expected;
    EXPECT_LT(Eigen::MatrixXd(error.triangularView<Eigen::Lower>()).cwiseAbs().maxCoeff(), 1e-4);
  }
}

}  // namespace
}  // namespace velour::matrix_product_test
