// Quadratic B-splines over view directions, for parameters that vary smoothly with the view.
//
// A view maps to the unit disk, at radius r = theta_v / (pi / 2) and its own azimuth. Isotropic splines cover one
// radius of that disk, mirrored at the center; the others a square grid over the disk, which has no seam and no pole.
// A spline of a view range covers only that part of the radius, or of the disk about its center; views outside the
// range have the value of the nearest view inside.
#pragma once

#include <algorithm>
#include <span>
#include <vector>
#include "math/sphere/vec.h"

namespace velour {

// An interval of view angles.

/// Polar angles of views in whole degrees; all of them by default.
struct ViewRange {
  int begin = 0, end = 90;

  bool whole() const { return begin <= 0 && end >= 90; }
  bool holds(double theta_v) const { return theta_v >= first() && theta_v <= last(); }
  // Radians.
  double first() const { return radians_from(static_cast<double>(begin)); }
  double last() const { return radians_from(static_cast<double>(end)); }
};

/// A view by its polar angle (radians, up to pi / 2) and its azimuth, whose cosine and sine are 1 and 0 at the normal.
template <class T>
struct PolarView {
  T theta, cos_phi, sin_phi;
};
PolarView<double> polar_view(const Vec3d& wv);
inline Vec3d direction_of(const PolarView<double>& view) {
  const double sine = std::sin(view.theta);
  return {sine * view.cos_phi, sine * view.sin_phi, std::cos(view.theta)};
}

/// The nodes that affect a view. Their weighted sum is the value of the spline, which is once differentiable.
template <class T>
struct ViewTapsOf {
  static constexpr int kMost = 9;
  int count = 0;
  int node[kMost];
  T weight[kMost];
  /// Weights for components that change sign across the normal (those along the azimuth of the view).
  /// Isotropic splines only; equal to `weight` in others.
  T odd_weight[kMost];

  void add(int to, T even, T odd) {
    node[count] = to;
    weight[count] = even;
    odd_weight[count++] = odd;
  }
};
using ViewTaps = ViewTapsOf<double>;

/// `cells` intervals over a radius (isotropic) or over each side of the square.
class ViewSpline {
 public:
  static constexpr int kMaxCells = 64;
  ViewSpline(bool isotropic, int cells, const ViewRange& views = {})
      : isotropic_(isotropic),
        mirrored_(isotropic && views.begin <= 0),
        cells_(cells),
        begin_(isotropic ? views.first() : 0.0),
        per_radian_(1 / (views.last() - begin_)) {}

  bool isotropic() const { return isotropic_; }
  int cells() const { return cells_; }
  /// Number of nodes along the radius or along a side of the square.
  int side() const { return cells_ + (mirrored_ ? 1 : 2); }
  int node_count() const { return isotropic_ ? side() : side() * side(); }
  /// Splits each interval into `times`; the result can represent every spline that this one can.
  ViewSpline refined(int times) const {
    ViewSpline finer = *this;
    finer.cells_ *= times;
    return finer;
  }
  /// Converts control values of this spline to those of refined(2); `odd` for components that change sign at the
  /// normal.
  std::vector<double> halved(std::span<const double> control, bool odd) const;
  /// The view on which a node has most influence: the center of its support, or the nearest view to it.
  PolarView<double> view_of(int node) const;
  /// Isotropic splines only. For each node a polar angle on which it has most influence: the middles of the intervals,
  /// the end, and the beginning unless it is mirrored there. Values at these angles determine the spline.
  std::vector<double> sites() const;
  /// Converts values at sites() to control values in place; `odd` for components that change sign at the normal.
  void interpolate(std::span<double> values, bool odd) const;
  /// Taps of unit `wv`, on or above the horizon.
  ViewTaps at(const Vec3d& wv) const { return at(polar_view(wv)); }
  /// Works in any precision: fits use double, renderers float.
  template <class T>
  ViewTapsOf<T> at(const PolarView<T>& view) const;

 private:
  /// The three quadratic B-splines on the cell of `x`, in [0, cells].
  template <class T>
  struct CellWeights {
    int cell;
    T weight[3];
    CellWeights(T x, int cells) : cell(std::clamp(static_cast<int>(x), 0, cells - 1)) {
      const T u = x - static_cast<T>(cell), half(0.5);
      weight[0] = half * (1 - u) * (1 - u);
      weight[1] = half + u * (1 - u);
      weight[2] = half * u * u;
    }
  };

  bool isotropic_, mirrored_;
  int cells_;
  double begin_, per_radian_;
};

template <class T>
ViewTapsOf<T> ViewSpline::at(const PolarView<T>& view) const {
  ViewTapsOf<T> taps;
  const T along = (view.theta - static_cast<T>(begin_)) * static_cast<T>(per_radian_);
  const T r = std::clamp(along, T(0), T(1)), size = static_cast<T>(cells_);
  if (isotropic_) {
    const CellWeights<T> c(r * size, cells_);
    const int first = c.cell - (mirrored_ ? 1 : 0);
    // If the radius begins at the normal, the node before the first is the mirror image of the first.
    if (first < 0) {
      taps.add(0, c.weight[0] + c.weight[1], c.weight[1] - c.weight[0]);
    } else {
      taps.add(first, c.weight[0], c.weight[0]);
      taps.add(first + 1, c.weight[1], c.weight[1]);
    }
    taps.add(first + 2, c.weight[2], c.weight[2]);
    return taps;
  }
  const T half_size = size / 2;
  const CellWeights<T> x(half_size * (1 + r * view.cos_phi), cells_), y(half_size * (1 + r * view.sin_phi), cells_);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const T weight = y.weight[i] * x.weight[j];
      taps.add((y.cell + i) * side() + x.cell + j, weight, weight);
    }
  }
  return taps;
}

/// Rises from 0 at the normal to 1 within a few degrees: 1 - exp(-(theta_v / 2.5 degrees)^2). At the normal an
/// isotropic material has no direction to stretch along.
double pole_fade(double theta_v);
inline double pole_fade(const Vec3d& wv) { return pole_fade(polar_view(wv).theta); }

}  // namespace velour
