#include "sphere/view_spline.h"

#include <algorithm>
#include <cmath>

namespace velour {
namespace {

/// The three quadratic B-splines on the cell of `x`, in [0, cells].
struct CellWeights {
  int cell;
  double weight[3];
};

CellWeights cell_weights(double x, int cells) {
  const int cell = std::clamp(static_cast<int>(x), 0, cells - 1);
  const double u = x - cell;
  return {cell, {0.5 * (1 - u) * (1 - u), 0.5 + u * (1 - u), 0.5 * u * u}};
}

double polar_angle(const Vec3d& w) { return std::atan2(std::hypot(w.x, w.y), w.z); }

}  // namespace

ViewTaps ViewSpline::at(const Vec3d& wv) const {
  ViewTaps taps;
  const double r = std::min(polar_angle(wv) / (kPiD / 2), 1.0);
  const auto add = [&](int node, double weight, double odd) {
    taps.node[taps.count] = node;
    taps.weight[taps.count] = weight;
    taps.odd_weight[taps.count++] = odd;
  };
  if (isotropic_) {
    const CellWeights c = cell_weights(r * cells_, cells_);
    // The node before the first is the first's own mirror image.
    if (c.cell == 0) {
      add(0, c.weight[0] + c.weight[1], c.weight[1] - c.weight[0]);
    } else {
      add(c.cell - 1, c.weight[0], c.weight[0]);
      add(c.cell, c.weight[1], c.weight[1]);
    }
    add(c.cell + 1, c.weight[2], c.weight[2]);
    return taps;
  }
  const double sine = std::hypot(wv.x, wv.y), scale = sine > 0 ? r / sine : 0.0;
  const CellWeights x = cell_weights(0.5 * (1 + scale * wv.x) * cells_, cells_);
  const CellWeights y = cell_weights(0.5 * (1 + scale * wv.y) * cells_, cells_);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double weight = y.weight[i] * x.weight[j];
      add((y.cell + i) * (cells_ + 2) + x.cell + j, weight, weight);
    }
  }
  return taps;
}

double pole_fade(const Vec3d& wv) {
  const double x = polar_angle(wv) / radians_from(2.5);
  return -std::expm1(-x * x);
}

}  // namespace velour
