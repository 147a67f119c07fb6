// Tensors as matrices.
#pragma once

#include "tensor/matrix_product.h"
#include "tensor/tensor_view.h"

namespace velour {

/// The mode-n unfolding, the matrix whose rows are the indices of a mode and whose columns are all others, as blocks of
/// columns that stay where they are: neighbouring modes that lie evenly in memory are one, of those the one of the
/// smallest stride that has enough indices makes the columns of a block, and there is a block for every index of the
/// rest.
class Unfolding {
 public:
  Unfolding(const TensorView& view, size_t mode);
  /// `like`: one of the same extents but for `mode`, whose blocks hold the same columns; `view` is row-major.
  Unfolding(const TensorView& view, size_t mode, const Unfolding& like);

  size_t blocks() const { return first_.size(); }
  Index rows() const { return rows_; }
  Index columns() const { return columns_; }  // of a block
  Index row_stride() const { return row_stride_; }
  Index column_stride() const { return column_stride_; }
  /// `count` columns of a block from column `begin` on; `data`: of the view.
  template <class T>
  StridedMatrix<T> part(T* data, size_t block, Index begin, Index count) const {
    return {data + first_[block] + begin * column_stride_, rows_, count, row_stride_, column_stride_};
  }

 private:
  using Group = std::pair<size_t, size_t>;  // modes first ... last
  void lay_out(const TensorView& view, size_t mode);

  std::vector<Group> group_;  // of all modes but this one
  size_t column_group_ = 0;
  Index rows_, columns_ = 1, row_stride_, column_stride_ = 1;
  std::vector<Index> first_;
};

}  // namespace velour
