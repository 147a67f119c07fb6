// Quadratic B-splines over view directions: how parameters vary smoothly with the view.
//
// The view is placed in the unit disk at radius r = theta_v / (pi / 2) and its own azimuth. Isotropic: one radius of
// that disk, mirrored at its centre; otherwise a square grid over the disk, which has no seam and no pole.
#pragma once

#include "sphere/vec.h"

namespace velour {

/// A view by its angles: the polar one, radians up to pi / 2, and the azimuth, 0 at the normal.
struct PolarView {
  double theta, cos_phi, sin_phi;
};
PolarView polar_view(const Vec3d& wv);

/// The nodes that a view touches. Sums over them are the spline's value there, once differentiable.
struct ViewTaps {
  static constexpr int kMost = 9;
  int count = 0;
  int node[kMost];
  double weight[kMost];
  /// The weights for components that change sign across the normal (what points along the view's azimuth).
  /// Isotropic splines only; elsewhere equal to `weight`.
  double odd_weight[kMost];
};

/// `cells` intervals over a radius (isotropic) or over each side of the square.
class ViewSpline {
 public:
  static constexpr int kMaxCells = 64;
  ViewSpline(bool isotropic, int cells) : isotropic_(isotropic), cells_(cells) {}

  bool isotropic() const { return isotropic_; }
  int cells() const { return cells_; }
  int node_count() const { return isotropic_ ? cells_ + 1 : (cells_ + 2) * (cells_ + 2); }
  /// Of unit `wv`, on or above the horizon.
  ViewTaps at(const Vec3d& wv) const { return at(polar_view(wv)); }
  ViewTaps at(const PolarView& view) const;

 private:
  bool isotropic_;
  int cells_;
};

/// 0 for a view along the normal, 1 from some degrees on: an isotropic material has no direction to stretch along
/// there. 1 - exp(-(theta_v / 2.5 degrees)^2).
double pole_fade(double theta_v);
inline double pole_fade(const Vec3d& wv) { return pole_fade(polar_view(wv).theta); }

}  // namespace velour
