// Dense tensors: non-owning views, owning tensors, and their products with matrices.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>
#include "base/progress.h"
#include "math/tensor/matrix_product.h"

namespace velour {

// Dense tensors: non-owning views and owning tensors.

// Row-major matrices, the layout of tensors and images.

using RowMatrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

using Index = Eigen::Index;

/// Non-owning view of a tensor with any strides.
class TensorView {
 public:
  /// Row-major: entries of the last mode are contiguous.
  TensorView(const float* data, std::vector<Index> extents);
  /// `strides` in entries.
  TensorView(const float* data, std::vector<Index> extents, std::vector<Index> strides);

  const float* data() const { return data_; }
  size_t order() const { return extent_.size(); }
  Index extent(size_t mode) const { return extent_[mode]; }
  Index stride(size_t mode) const { return stride_[mode]; }
  const std::vector<Index>& extents() const { return extent_; }
  Index size() const;

  /// Indices first ... first + count - 1 of a mode.
  TensorView range(size_t mode, Index first, Index count) const;
  /// Mode i of the result is mode order[i].
  TensorView permuted(const std::vector<size_t>& order) const;

 private:
  const float* data_;
  std::vector<Index> extent_, stride_;
};

/// Row-major tensor that owns its entries.
struct DenseTensor {
  explicit DenseTensor(std::vector<Index> extents);

  TensorView view() const { return {data.data(), extent}; }
  double squared_norm() const;

  std::vector<Index> extent;
  std::vector<float> data;
};

/// Copies the entries to a row-major tensor.
DenseTensor copied(const TensorView& view);

// Unfoldings of tensors into matrices.

/// The mode-n unfolding, the matrix whose rows are the indices of a mode and whose columns are all others, as blocks of
/// columns that stay in place. Adjacent modes that are contiguous in memory are merged. The merged mode with the
/// smallest stride among those with enough indices forms the columns of a block; there is one block for every index of
/// the others.
class Unfolding {
 public:
  Unfolding(const TensorView& view, size_t mode);
  /// Uses blocks of the same columns as `like`, which has the same extents except for `mode`. `view` is row-major.
  Unfolding(const TensorView& view, size_t mode, const Unfolding& like);

  size_t blocks() const { return first_.size(); }
  Index rows() const { return rows_; }
  Index columns() const { return columns_; }  // per block
  Index row_stride() const { return row_stride_; }
  Index column_stride() const { return column_stride_; }
  /// Columns [begin, begin + count) of a block; `data`: the data of the view.
  template <class T>
  StridedMatrix<T> part(T* data, size_t block, Index begin, Index count) const {
    return {data + first_[block] + begin * column_stride_, rows_, count, row_stride_, column_stride_};
  }

 private:
  using Group = std::pair<size_t, size_t>;  // modes first ... last
  void lay_out(const TensorView& view, size_t mode);

  std::vector<Group> group_;  // all modes except this one
  size_t column_group_ = 0;
  Index rows_, columns_ = 1, row_stride_, column_stride_ = 1;
  std::vector<Index> first_;
};

// Products of tensors with matrices.

/// view x_mode matrix: multiplies every column of the mode's unfolding by `matrix`, which has a column per index of the
/// mode. The result is row-major and bit-identical for any number of threads.
DenseTensor mode_product(const TensorView& view, size_t mode, const RowMatrix& matrix, int threads,
                         const Progress& progress);

/// The unfolding times its transpose, in double: inner products of all pairs of slices of the mode. Bit-identical for
/// any number of threads.
Eigen::MatrixXd slice_products(const TensorView& view, size_t mode, int threads, const Progress& progress);

}  // namespace velour
