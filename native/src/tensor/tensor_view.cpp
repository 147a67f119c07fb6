#include "tensor/tensor_view.h"

#include <numeric>

namespace velour {
namespace {

Index product(const std::vector<Index>& extents) {
  return std::accumulate(extents.begin(), extents.end(), Index{1}, std::multiplies<>());
}

std::vector<Index> row_major(const std::vector<Index>& extents) {
  std::vector<Index> strides(extents.size(), 1);
  for (size_t mode = extents.size(); mode-- > 1;) strides[mode - 1] = strides[mode] * extents[mode];
  return strides;
}

void copy_mode(const TensorView& view, size_t mode, const float* from, float*& to) {
  if (mode == view.order()) {
    *to++ = *from;
    return;
  }
  for (Index i = 0; i < view.extent(mode); ++i) copy_mode(view, mode + 1, from + i * view.stride(mode), to);
}

}  // namespace

TensorView::TensorView(const float* data, std::vector<Index> extents)
    : data_(data), extent_(std::move(extents)), stride_(row_major(extent_)) {}

TensorView::TensorView(const float* data, std::vector<Index> extents, std::vector<Index> strides)
    : data_(data), extent_(std::move(extents)), stride_(std::move(strides)) {}

Index TensorView::size() const { return product(extent_); }

TensorView TensorView::range(size_t mode, Index first, Index count) const {
  TensorView part = *this;
  part.data_ += first * stride_[mode];
  part.extent_[mode] = count;
  return part;
}

TensorView TensorView::permuted(const std::vector<size_t>& order) const {
  TensorView other = *this;
  for (size_t i = 0; i < order.size(); ++i) {
    other.extent_[i] = extent_[order[i]];
    other.stride_[i] = stride_[order[i]];
  }
  return other;
}

DenseTensor::DenseTensor(std::vector<Index> extents)
    : extent(std::move(extents)), data(static_cast<size_t>(product(extent))) {}

double DenseTensor::squared_norm() const {
  double sum = 0;
  for (const float x : data) sum += static_cast<double>(x) * static_cast<double>(x);
  return sum;
}

DenseTensor copied(const TensorView& view) {
  DenseTensor tensor(view.extents());
  float* to = tensor.data.data();
  copy_mode(view, 0, view.data(), to);
  return tensor;
}

}  // namespace velour
