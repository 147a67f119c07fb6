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

}  // namespace

PolarView polar_view(const Vec3d& wv) {
  const double sine = std::hypot(wv.x, wv.y);
  if (sine == 0) return {0, 1, 0};
  return {std::atan2(sine, wv.z), wv.x / sine, wv.y / sine};
}

ViewTaps ViewSpline::at(const PolarView& view) const {
  ViewTaps taps;
  const double r = std::min(view.theta / (kPiD / 2), 1.0);
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
  const CellWeights x = cell_weights(0.5 * (1 + r * view.cos_phi) * cells_, cells_);
  const CellWeights y = cell_weights(0.5 * (1 + r * view.sin_phi) * cells_, cells_);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double weight = y.weight[i] * x.weight[j];
      add((y.cell + i) * (cells_ + 2) + x.cell + j, weight, weight);
    }
  }
  return taps;
}

double pole_fade(double theta_v) {
  const double x = theta_v / radians_from(2.5);
  return -std::expm1(-x * x);
}

}  // namespace velour
