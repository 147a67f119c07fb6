// An interval of view angles.
#pragma once

#include "sphere/vec.h"

namespace velour {

/// Polar angles of views in whole degrees; all of them by default.
struct ViewRange {
  int begin = 0, end = 90;

  bool whole() const { return begin <= 0 && end >= 90; }
  bool holds(double theta_v) const { return theta_v >= first() && theta_v <= last(); }
  // Radians.
  double first() const { return radians_from(static_cast<double>(begin)); }
  double last() const { return radians_from(static_cast<double>(end)); }
};

}  // namespace velour
