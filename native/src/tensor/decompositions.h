// Decompositions of dense matrices. Instantiated here only, because each takes ten seconds to compile.
#pragma once

#include "tensor/row_matrix.h"

namespace velour {

/// Eigenvalues and eigenvectors of a symmetric matrix, largest value first; vectors are orthonormal columns.
struct Eigenpairs {
  Eigen::VectorXd value;
  Eigen::MatrixXd vector;
};

/// All eigenpairs; reads only the lower triangle.
Eigenpairs eigenpairs(const Eigen::MatrixXd& symmetric);

/// The symmetric inverse of the square root of a positive definite matrix.
Eigen::MatrixXd inverse_root(const Eigen::MatrixXd& symmetric);

/// Orthonormal basis of the columns of `m`, with as many columns as `m`, which has no more columns than rows.
RowMatrix orthonormal(const RowMatrix& m);
Eigen::MatrixXd orthonormal_doubles(const Eigen::MatrixXd& m);

/// m = basis * triangle.
struct QrParts {
  RowMatrix basis;     // as orthonormal(m)
  RowMatrix triangle;  // upper
};
QrParts qr_parts(const RowMatrix& m);

}  // namespace velour
