// Decompositions of dense matrices. Here alone, because Eigen's templates for each take the compiler ten seconds.
#pragma once

#include "tensor/row_matrix.h"

namespace velour {

/// Of a symmetric matrix, the largest value first; vectors are orthonormal columns.
struct Eigenpairs {
  Eigen::VectorXd value;
  Eigen::MatrixXd vector;
};

/// All of them; reads the lower triangle.
Eigenpairs eigenpairs(const Eigen::MatrixXd& symmetric);

/// The symmetric inverse of the square root of a positive definite matrix.
Eigen::MatrixXd inverse_root(const Eigen::MatrixXd& symmetric);

/// An orthonormal basis of the columns of `m`, as many columns (at most as many as rows).
RowMatrix orthonormal(const RowMatrix& m);
Eigen::MatrixXd orthonormal_doubles(const Eigen::MatrixXd& m);

/// m = basis * triangle.
struct QrParts {
  RowMatrix basis;     // as orthonormal(m)
  RowMatrix triangle;  // upper
};
QrParts qr_parts(const RowMatrix& m);

}  // namespace velour
