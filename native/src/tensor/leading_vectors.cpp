#include "tensor/leading_vectors.h"

#include <algorithm>

#include "sphere/random.h"
#include "tensor/decompositions.h"
#include "tensor/leading_eigenvectors.h"
#include "tensor/mode_product.h"

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

}  // namespace velour
