// Where a factored BTF's components stand.
#pragma once

#include <array>

#include "btf/factored_btf.h"

namespace velour {

/// Numbers of components, by the view that they serve and by colour axis.
class ComponentRanges {
 public:
  struct Range {
    uint32_t begin, end;
    uint32_t count() const { return end - begin; }
  };

  explicit ComponentRanges(const FactoredBtf& btf);

  /// Of all axes.
  Range of(size_t view) const { return {bounds(view)[0], bounds(view)[3]}; }
  Range of(size_t view, size_t axis) const { return {bounds(view)[axis], bounds(view)[axis + 1]}; }
  /// How many views differ in them: 1 where all share all.
  size_t groups() const { return bounds_.size(); }

 private:
  using Bounds = std::array<uint32_t, 4>;  // where each axis begins, and the end
  const Bounds& bounds(size_t view) const { return bounds_[bounds_.size() == 1 ? 0 : view]; }

  std::vector<Bounds> bounds_;
};

}  // namespace velour
