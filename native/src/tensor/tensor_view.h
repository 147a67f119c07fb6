// Dense tensors: views of memory, and tensors that own theirs.
#pragma once

#include <utility>
#include <vector>

#include "tensor/row_matrix.h"

namespace velour {

using Index = Eigen::Index;

/// Entries somewhere in memory, mode by mode; owns nothing.
class TensorView {
 public:
  /// Row-major: entries of the last mode lie side by side.
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

/// Row-major.
struct DenseTensor {
  explicit DenseTensor(std::vector<Index> extents);

  TensorView view() const { return {data.data(), extent}; }
  double squared_norm() const;

  std::vector<Index> extent;
  std::vector<float> data;
};

/// The same entries, row-major.
DenseTensor copied(const TensorView& view);

}  // namespace velour
