// Quadratic B-splines over view directions: how parameters vary smoothly with the view.
//
// The view is placed in the unit disk at radius r = theta_v / (pi / 2) and its own azimuth. Isotropic: one radius of
// that disk, mirrored at its centre; otherwise a square grid over the disk, which has no seam and no pole. A spline of
// a range of views covers the part of the radius, or of the disk about its centre, that the range takes; views outside
// have the value of the range's nearest.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "sphere/vec.h"
#include "sphere/view_range.h"

namespace velour {

/// A view by its angles: the polar one, radians up to pi / 2, and the azimuth, 1 and 0 at the normal.
template <class T>
struct PolarView {
  T theta, cos_phi, sin_phi;
};
PolarView<double> polar_view(const Vec3d& wv);
inline Vec3d direction_of(const PolarView<double>& view) {
  const double sine = std::sin(view.theta);
  return {sine * view.cos_phi, sine * view.sin_phi, std::cos(view.theta)};
}

/// The nodes that a view touches. Sums over them are the spline's value there, once differentiable.
template <class T>
struct ViewTapsOf {
  static constexpr int kMost = 9;
  int count = 0;
  int node[kMost];
  T weight[kMost];
  /// The weights for components that change sign across the normal (what points along the view's azimuth).
  /// Isotropic splines only; elsewhere equal to `weight`.
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
  /// Along the radius, or along a side of the square.
  int side() const { return cells_ + (mirrored_ ? 1 : 2); }
  int node_count() const { return isotropic_ ? side() : side() * side(); }
  /// With each interval cut into `times`: what this spline can be, that one can be.
  ViewSpline refined(int times) const {
    ViewSpline finer = *this;
    finer.cells_ *= times;
    return finer;
  }
  /// The control values that refined(2) has for what `control` are here; `odd` for components that change sign at the
  /// normal.
  std::vector<double> halved(std::span<const double> control, bool odd) const;
  /// The view that is mostly a node's own: in the middle of what it reaches, or the nearest to it that there is.
  PolarView<double> view_of(int node) const;
  /// Of isotropic splines, for each node a polar angle that is mostly its own: the middles of the intervals, the end,
  /// and the beginning unless it is mirrored there. Values at these determine the spline.
  std::vector<double> sites() const;
  /// Makes of the values at sites() the control values, in place; `odd` for components that change sign at the normal.
  void interpolate(std::span<double> values, bool odd) const;
  /// Of unit `wv`, on or above the horizon.
  ViewTaps at(const Vec3d& wv) const { return at(polar_view(wv)); }
  /// The same in any precision: fits want double, renderers float.
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
    // Where the radius begins at the normal, the node before the first is the first's own mirror image.
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

/// 0 for a view along the normal, 1 from some degrees on: an isotropic material has no direction to stretch along
/// there. 1 - exp(-(theta_v / 2.5 degrees)^2).
double pole_fade(double theta_v);
inline double pole_fade(const Vec3d& wv) { return pole_fade(polar_view(wv).theta); }

}  // namespace velour
