#include "tensor/unfolding.h"

#include <algorithm>

namespace velour {
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
