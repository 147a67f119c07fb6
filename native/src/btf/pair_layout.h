// Which pairs of directions a BTF was taken at, and in which order its images come.
#pragma once

#include <cstdint>
#include <vector>

#include "btf/polar_angles.h"

namespace velour {

/// Pairs in the order of their views, within a view in the order of their lights. A pair is numbered by its place.
class PairLayout {
 public:
  /// Every view with every light. Throws Error(invalid_argument) when a set is empty, holds a direction twice, or one
  /// that is not finite or within a tenth of a degree of the plane.
  PairLayout(std::vector<PolarAngles> views, std::vector<PolarAngles> lights);
  /// `lights_of_view[v]`: numbers of the lights that view v was taken with, rising; may be empty.
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
