// Tensors as matrices.
#pragma once

#include "tensor/tensor_view.h"

namespace velour {

/// The mode-n unfolding, the matrix whose rows are the indices of a mode and whose columns are all others, as blocks of
/// columns that stay where they are: neighbouring modes that lie evenly in memory are one, of those the one of the
/// smallest stride makes the columns of a block, and there is a block for every index of the rest.
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
  /// Of a block in the memory of the view.
  Index first(size_t block) const { return first_[block]; }

 private:
  using Group = std::pair<size_t, size_t>;  // modes first ... last
  void lay_out(const TensorView& view, size_t mode);

  std::vector<Group> group_;  // of all modes but this one
  size_t column_group_ = 0;
  Index rows_, columns_ = 1, row_stride_, column_stride_ = 1;
  std::vector<Index> first_;
};

/// Calls use(matrix) with rows() x `count` of a block from column `begin` on, as Eigen knows it; strides that it cannot
/// use are copied.
template <class Use>
void with_columns(const float* data, const Unfolding& u, size_t block, Index begin, Index count, const Use& use) {
  using ColumnMatrix = Eigen::MatrixXf;
  const float* const from = data + u.first(block) + begin * u.column_stride();
  const Eigen::OuterStride<> row_stride(u.row_stride()), column_stride(u.column_stride());
  if (u.column_stride() == 1) {
    use(Eigen::Map<const RowMatrix, 0, Eigen::OuterStride<>>(from, u.rows(), count, row_stride));
  } else if (u.row_stride() == 1) {
    use(Eigen::Map<const ColumnMatrix, 0, Eigen::OuterStride<>>(from, u.rows(), count, column_stride));
  } else {
    using Both = Eigen::Stride<Eigen::Dynamic, Eigen::Dynamic>;
    use(ColumnMatrix(
        Eigen::Map<const ColumnMatrix, 0, Both>(from, u.rows(), count, Both(u.column_stride(), u.row_stride()))));
  }
}

}  // namespace velour
