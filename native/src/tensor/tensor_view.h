// Dense tensors: non-owning views and owning tensors.
#pragma once

#include <utility>
#include <vector>

#include "tensor/row_matrix.h"

namespace velour {

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

}  // namespace velour
