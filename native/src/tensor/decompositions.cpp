#include "tensor/decompositions.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace velour {
namespace {

using Solver = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;
template <class Matrix>
using Qr = Eigen::HouseholderQR<Matrix>;

template <class Matrix>
Matrix basis_of(const Qr<Matrix>& qr) {
  return qr.householderQ() * Matrix::Identity(qr.rows(), qr.cols());
}

}  // namespace

Eigenpairs eigenpairs(const Eigen::MatrixXd& symmetric) {
  const Solver solver(symmetric);
  return {solver.eigenvalues().reverse(), solver.eigenvectors().rowwise().reverse()};
}

Eigen::MatrixXd inverse_root(const Eigen::MatrixXd& symmetric) { return Solver(symmetric).operatorInverseSqrt(); }

RowMatrix orthonormal(const RowMatrix& m) { return basis_of(Qr<Eigen::MatrixXf>(m)); }

Eigen::MatrixXd orthonormal_doubles(const Eigen::MatrixXd& m) { return basis_of(Qr<Eigen::MatrixXd>(m)); }

QrParts qr_parts(const RowMatrix& m) {
  const Qr<Eigen::MatrixXf> qr(m);
  return {basis_of(qr), qr.matrixQR().topRows(m.cols()).triangularView<Eigen::Upper>()};
}

}  // namespace velour
