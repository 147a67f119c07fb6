#include "math/tensor/tensor_view.h"

#include <algorithm>
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

namespace {

constexpr Index kEnoughColumns = 16;  // enough to fill the registers

}  // namespace

Unfolding::Unfolding(const TensorView& view, size_t mode) {
  for (size_t k = 0; k < view.order(); ++k) {
    if (k == mode) continue;
    const bool evenly = k > 0 && k - 1 != mode && view.stride(k - 1) == view.stride(k) * view.extent(k);
    if (evenly) {
      group_.back().second = k;
    } else {
      group_.emplace_back(k, k);
    }
  }
  // Too few columns would leave registers empty; a large stride would waste cache lines.
  const auto rank = [&](const Group& group) {
    Index extent = 1;
    for (size_t k = group.first; k <= group.second; ++k) extent *= view.extent(k);
    return std::pair(std::min(extent, kEnoughColumns), -view.stride(group.second));
  };
  for (size_t g = 1; g < group_.size(); ++g) {
    if (rank(group_[g]) > rank(group_[column_group_])) column_group_ = g;
  }
  lay_out(view, mode);
}

Unfolding::Unfolding(const TensorView& view, size_t mode, const Unfolding& like)
    : group_(like.group_), column_group_(like.column_group_) {
  lay_out(view, mode);
}

void Unfolding::lay_out(const TensorView& view, size_t mode) {
  rows_ = view.extent(mode);
  row_stride_ = view.stride(mode);
  first_ = {0};
  for (size_t g = 0; g < group_.size(); ++g) {
    Index extent = 1;
    for (size_t k = group_[g].first; k <= group_[g].second; ++k) extent *= view.extent(k);
    const Index stride = view.stride(group_[g].second);
    if (g == column_group_) {
      columns_ = extent;
      column_stride_ = stride;
      continue;
    }
    std::vector<Index> next;
    for (const Index from : first_) {
      for (Index i = 0; i < extent; ++i) next.push_back(from + i * stride);
    }
    first_ = std::move(next);
  }
}

}  // namespace velour
