// The pairs of directions of a BTF and the order of its images.
#pragma once

#include <cstdint>
#include <vector>

#include "btf/polar_angles.h"

namespace velour {

/// Pairs are numbered by view, then by light.
class PairLayout {
 public:
  /// Pairs every view with every light. Throws Error(invalid_argument) if a set is empty, or contains a direction that
  /// is repeated, not finite, or within 0.1 degrees of the plane.
  PairLayout(std::vector<PolarAngles> views, std::vector<PolarAngles> lights);
  /// `lights_of_view[v]`: indices of the lights paired with view v, ascending; may be empty.
  PairLayout(std::vector<PolarAngles> views, std::vector<PolarAngles> lights,
             const std::vector<std::vector<uint32_t>>& lights_of_view);

  const std::vector<PolarAngles>& views() const { return views_; }
  const std::vector<PolarAngles>& lights() const { return lights_; }
  uint64_t pairs() const { return light_of_pair_.size(); }
  /// Pairs of view v are numbered [first(v), first(v + 1)).
  uint64_t first(size_t view) const { return first_[view]; }
  uint32_t light_of(uint64_t pair) const { return light_of_pair_[pair]; }
  uint32_t view_of(uint64_t pair) const;
  /// Whether every view has every light.
  bool complete() const { return pairs() == views_.size() * lights_.size(); }
  /// Unit vectors of a pair.
  DirectionPair directions(uint64_t pair) const;

  bool operator==(const PairLayout&) const = default;

 private:
  void check() const;

  std::vector<PolarAngles> views_, lights_;
  std::vector<uint64_t> first_;  // views + 1
  std::vector<uint32_t> light_of_pair_;
};

}  // namespace velour
