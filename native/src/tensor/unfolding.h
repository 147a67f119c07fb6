// Unfoldings of tensors into matrices.
#pragma once

#include "tensor/matrix_product.h"
#include "tensor/tensor_view.h"

namespace velour {

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

}  // namespace velour
