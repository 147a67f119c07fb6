// Directions that become denser towards an axis.
#pragma once

#include <vector>

#include "sphere/frame.h"

namespace velour {

/// Rings about an axis: the cap within `inner` radians, then cells of equal width on a logarithmic scale up to `outer`.
class CloseRings {
 public:
  CloseRings(const Vec3& axis, double inner, double outer, int rings, int spokes)
      : axis_(axis), frame_(Frame::about(axis)), inner_(inner), outer_(outer), rings_(rings), spokes_(spokes) {}

  size_t spokes() const { return static_cast<size_t>(spokes_); }

  /// Appends one direction per cell, ring by ring from the inside.
  void append(std::vector<Vec3>& out) const;
  /// Directions per steradian at `w`; 0 beyond the last ring.
  double density(const Vec3& w) const;

 private:
  double log_step() const;
  /// Inner radius of ring i > 0, radians.
  double edge(int i) const;

  Vec3 axis_;
  Frame frame_;
  double inner_, outer_;
  int rings_, spokes_;
};

}  // namespace velour
