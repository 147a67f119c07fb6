#include "math/tensor/decompositions.h"

#include <algorithm>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <numeric>
#include "math/tensor/mode_product.h"

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

namespace {

/// Modes in the order in which they shrink, most first.
std::vector<size_t> by_shrinking(const std::vector<Index>& extents, const std::vector<Index>& ranks) {
  std::vector<size_t> order(extents.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return ranks[a] * extents[b] < ranks[b] * extents[a]; });
  return order;
}

}  // namespace

DenseTensor projected(const TensorView& view, const std::vector<RowMatrix>& factor, size_t but,
                      const TensorOptions& options, const Progress& progress) {
  std::vector<Index> ranks;
  for (size_t mode = 0; mode < view.order(); ++mode) {
    ranks.push_back(factor[mode].size() > 0 ? factor[mode].cols() : view.extent(mode));
  }
  DenseTensor result{{}};
  bool begun = false;
  for (const size_t mode : by_shrinking(view.extents(), ranks)) {
    if (mode == but || factor[mode].size() == 0) continue;
    result = mode_product(begun ? result.view() : view, mode, factor[mode].transpose(), options.threads, progress);
    begun = true;
  }
  return begun ? std::move(result) : copied(view);
}

Tucker truncated_hosvd(const TensorView& view, const std::vector<Index>& ranks, const TensorOptions& options,
                       const Progress& progress) {
  Tucker tucker;
  tucker.factor.resize(view.order());
  tucker.core = copied(view);
  for (const size_t mode : by_shrinking(view.extents(), ranks)) {
    tucker.factor[mode] = leading_vectors(tucker.core.view(), mode, ranks[mode], options, progress);
    tucker.core = mode_product(tucker.core.view(), mode, tucker.factor[mode].transpose(), options.threads, progress);
  }
  return tucker;
}

void hooi_sweep(const TensorView& view, Tucker& tucker, const TensorOptions& options, const Progress& progress) {
  std::vector<RowMatrix>& factor = tucker.factor;
  const auto improve = [&](const DenseTensor& rest, size_t mode) {
    factor[mode] = leading_vectors(rest.view(), mode, factor[mode].cols(), options, progress);
    return mode_product(rest.view(), mode, factor[mode].transpose(), options.threads, progress);
  };
  tucker.core = improve(projected(view, factor, 0, options, progress), 0);
  if (view.order() == 1) return;
  // All other modes use the tensor projected on the new factor of the first.
  const DenseTensor seen = mode_product(view, 0, factor[0].transpose(), options.threads, progress);
  for (size_t mode = 1; mode < view.order(); ++mode) {
    std::vector<RowMatrix> others = factor;
    others[0] = {};
    tucker.core = improve(projected(seen.view(), others, mode, options, progress), mode);
  }
}

DenseTensor expanded(const Tucker& tucker, const TensorOptions& options, const Progress& progress) {
  DenseTensor tensor = tucker.core;
  for (size_t mode = 0; mode < tucker.factor.size(); ++mode) {
    tensor = mode_product(tensor.view(), mode, tucker.factor[mode], options.threads, progress);
  }
  return tensor;
}

}  // namespace velour
