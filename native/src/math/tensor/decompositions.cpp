#include "math/tensor/decompositions.h"

#include <algorithm>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <numeric>
#include <optional>

#include "base/parallel.h"
#include "math/sphere/random.h"
#include "math/tensor/tensor_view.h"

namespace velour {

namespace {

constexpr Index kSide = 1024;  // largest Gram matrix to decompose
constexpr Index kSketchOversampling = 10;
constexpr int kPowers = 3;

/// The unfolding as a tensor of two modes: in place if its strides allow it, otherwise copied to `storage`.
TensorView unfolded(const TensorView& view, size_t mode, DenseTensor& storage) {
  const Unfolding unfolding(view, mode);
  if (unfolding.blocks() == 1) {
    return {view.data(), {unfolding.rows(), unfolding.columns()}, {unfolding.row_stride(), unfolding.column_stride()}};
  }
  std::vector<size_t> order{mode};
  for (size_t k = 0; k < view.order(); ++k) {
    if (k != mode) order.push_back(k);
  }
  storage = copied(view.permuted(order));
  return {storage.data.data(), {unfolding.rows(), view.size() / unfolding.rows()}};
}

/// Leading vectors within the span of the orthonormal columns of `basis`.
RowMatrix leading_within(const TensorView& view, size_t mode, const RowMatrix& basis, Index rank,
                         const TensorOptions& options, const Progress& progress) {
  const DenseTensor response = mode_product(view, mode, basis.transpose(), options.threads, progress);
  return basis *
         leading_eigenvectors(slice_products(response.view(), mode, options.threads, progress), rank, options, progress)
             .cast<float>();
}

/// Leading vectors from the Gram matrix of the columns.
RowMatrix leading_by_columns(const TensorView& view, size_t mode, Index rank, const TensorOptions& options,
                             const Progress& progress) {
  DenseTensor storage{{}};
  const TensorView matrix = unfolded(view, mode, storage);
  const Index rows = matrix.extent(0);
  const RowMatrix right = leading_eigenvectors(slice_products(matrix, 1, options.threads, progress),
                                               std::min(rank, matrix.extent(1)), options, progress)
                              .cast<float>();
  const DenseTensor left = mode_product(matrix, 1, right.transpose(), options.threads, progress);
  RowMatrix all = RowMatrix::Zero(rows, rank);  // any direction serves beyond the number of columns
  all.leftCols(right.cols()) = Eigen::Map<const RowMatrix>(left.data.data(), rows, right.cols());
  return orthonormal(all);
}

}  // namespace

RowMatrix random_range(const TensorView& view, size_t mode, Index columns, int powers, const TensorOptions& options,
                       const Progress& progress) {
  DenseTensor storage{{}};
  const TensorView a = unfolded(view, mode, storage);
  RowMatrix random(columns, a.extent(1));
  for (Index c = 0; c < random.cols(); ++c) {
    RandomStream numbers(options.seed, static_cast<uint64_t>(c), mode);
    // The sum of three uniform numbers is close enough to a normal distribution.
    for (Index r = 0; r < columns; ++r) {
      const float u = numbers.next(), v = numbers.next();
      random(r, c) = u + v + numbers.next() - 1.5f;
    }
  }
  const auto times = [&](size_t along, const RowMatrix& m) {
    DenseTensor product = mode_product(a, along, m, options.threads, progress);
    return RowMatrix(Eigen::Map<RowMatrix>(product.data.data(), product.extent[0], product.extent[1]));
  };
  RowMatrix basis = orthonormal(times(1, random));
  for (int i = 0; i < powers; ++i) {
    const RowMatrix rows = orthonormal(times(0, basis.transpose()).transpose());
    basis = orthonormal(times(1, rows.transpose()));
  }
  return basis;
}

RowMatrix leading_vectors(const TensorView& view, size_t mode, Index rank, const TensorOptions& options,
                          const Progress& progress) {
  const Index rows = view.extent(mode), columns = view.size() / std::max<Index>(rows, 1);
  if (rows <= std::min(columns, kSide)) {
    return leading_eigenvectors(slice_products(view, mode, options.threads, progress), rank, options, progress)
        .cast<float>();
  }
  if (columns <= kSide) return leading_by_columns(view, mode, rank, options, progress);
  const Index wide = std::min({rank + kSketchOversampling, rows, columns});
  const RowMatrix basis = random_range(view, mode, wide, kPowers, options, progress);
  return leading_within(view, mode, basis, rank, options, progress);
}

namespace {

constexpr Index kBlockOversampling = 8;
constexpr Index kMinSide = 160;     // smallest matrix for which a Krylov space pays off
constexpr Index kMinBlocks = 6;     // that must fit in the space; with fewer a decomposition is cheaper
constexpr double kResidual = 1e-7;  // relative to the largest eigenvalue
constexpr Index kRows = 128;        // per piece of work

Eigen::MatrixXd decomposed(const Eigen::MatrixXd& products, Index rank) {
  return eigenpairs(products).vector.leftCols(rank);
}

Eigen::MatrixXd random_block(Index rows, Index columns, uint64_t seed) {
  Eigen::MatrixXd block(rows, columns);
  for (Index c = 0; c < columns; ++c) {
    RandomStream random(seed, static_cast<uint64_t>(c), 0);
    for (Index r = 0; r < rows; ++r) block(r, c) = static_cast<double>(random.next()) - 0.5;
  }
  return block;
}

/// Krylov space of a random block and its repeated products with the matrix; grows block by block.
class KrylovSpace {
 public:
  KrylovSpace(const Eigen::MatrixXd& products, Index block, Index most, const TensorOptions& options,
              const Progress& progress)
      : products_(products), options_(options), progress_(progress), basis_(products.rows(), most), image_(basis_) {
    next_ = orthonormal_doubles(random_block(products.rows(), block, options.seed));
  }

  bool has_room() const { return size_ + next_.cols() <= basis_.cols(); }

  void grow() {
    const Index block = next_.cols();
    basis_.middleCols(size_, block) = next_;
    parallel_pieces(
        static_cast<size_t>((products_.rows() + kRows - 1) / kRows), options_.threads, progress_, [&](size_t piece) {
          const Index begin = static_cast<Index>(piece) * kRows, count = std::min(kRows, products_.rows() - begin);
          image_.block(begin, size_, count, block).noalias() = products_.middleRows(begin, count) * next_;
        });
    next_ = image_.middleCols(size_, block);
    size_ += block;
    // Orthogonalizing once is not enough where little of the image lies outside the space.
    for (int twice = 0; twice < 2; ++twice) {
      const auto before = basis_.leftCols(size_);
      next_ = orthonormal_doubles(next_ - before * (before.transpose() * next_).eval());
    }
  }

  /// Ritz vectors, the best approximations of the leading eigenvectors in the space; none if residuals are too large.
  std::optional<Eigen::MatrixXd> leading(Index rank) const {
    const auto basis = basis_.leftCols(size_), image = image_.leftCols(size_);
    const Eigenpairs pairs = eigenpairs(basis.transpose() * image);
    const Eigen::MatrixXd weight = pairs.vector.leftCols(rank);
    const Eigen::VectorXd value = pairs.value.head(rank);
    Eigen::MatrixXd vectors = basis * weight;
    const Eigen::MatrixXd residual = image * weight - vectors * value.asDiagonal();
    if (!(residual.colwise().norm().maxCoeff() <= kResidual * value[0])) return std::nullopt;
    return vectors;
  }

 private:
  const Eigen::MatrixXd& products_;
  TensorOptions options_;
  const Progress& progress_;
  Eigen::MatrixXd basis_, image_, next_;
  Index size_ = 0;
};

}  // namespace

Eigen::MatrixXd leading_eigenvectors(const Eigen::MatrixXd& products, Index rank, const TensorOptions& options,
                                     const Progress& progress) {
  const Index side = products.rows(), block = rank + kBlockOversampling, most = side / 2;
  if (side < kMinSide || kMinBlocks * block > most) return decomposed(products, rank);
  KrylovSpace space(products, block, most, options, progress);
  while (space.has_room()) {
    space.grow();
    if (const auto found = space.leading(rank)) return *found;
  }
  return decomposed(products, rank);
}

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
