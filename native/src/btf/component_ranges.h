// Component ranges of a factored BTF.
#pragma once

#include <array>

#include "btf/factored_btf.h"

namespace velour {

/// Indices of components by the view they serve and by color axis.
class ComponentRanges {
 public:
  struct Range {
    uint32_t begin, end;
    uint32_t count() const { return end - begin; }
  };

  explicit ComponentRanges(const FactoredBtf& btf);

  /// Components of all axes.
  Range of(size_t view) const { return {bounds(view)[0], bounds(view)[3]}; }
  Range of(size_t view, size_t axis) const { return {bounds(view)[axis], bounds(view)[axis + 1]}; }
  /// Number of component groups: one per view, or 1 if all views share all components.
  size_t groups() const { return bounds_.size(); }

 private:
  using Bounds = std::array<uint32_t, 4>;  // first component of each axis, and the end
  const Bounds& bounds(size_t view) const { return bounds_[bounds_.size() == 1 ? 0 : view]; }

  std::vector<Bounds> bounds_;
};

}  // namespace velour
