#include "math/sphere/view_spline.h"

#include <cmath>

namespace velour {

PolarView<double> polar_view(const Vec3d& wv) {
  const double sine = std::hypot(wv.x, wv.y);
  if (sine == 0) return {0, 1, 0};
  return {std::atan2(sine, wv.z), wv.x / sine, wv.y / sine};
}

PolarView<double> ViewSpline::view_of(int node) const {
  if (isotropic_) return {sites()[static_cast<size_t>(node)], 1, 0};
  const auto place = [&](int i) { return 2 * (i - 0.5) / cells_ - 1; };
  const double x = place(node % side()), y = place(node / side()), r = std::hypot(x, y);
  return {std::min(r, 1.0) / per_radian_, r > 0 ? x / r : 1, r > 0 ? y / r : 0};
}

std::vector<double> ViewSpline::sites() const {
  const double step = 1 / (per_radian_ * cells_);
  std::vector<double> theta;
  if (!mirrored_) theta.push_back(begin_);
  for (int i = 0; i < cells_; ++i) theta.push_back(begin_ + (i + 0.5) * step);
  theta.push_back(begin_ + cells_ * step);
  return theta;
}

/// At most three adjacent nodes affect a site, so the system is tridiagonal; it is also diagonally dominant.
void ViewSpline::interpolate(std::span<double> values, bool odd) const {
  const auto theta = sites();
  std::vector<double> after(theta.size());  // coefficient of the next unknown after forward elimination
  for (size_t i = 0; i < theta.size(); ++i) {
    const auto taps = at(PolarView<double>{theta[i], 1, 0});
    double row[3] = {0, 0, 0};  // coefficients of the unknowns i - 1, i, i + 1
    for (int k = 0; k < taps.count; ++k) {
      const int column = taps.node[k] - static_cast<int>(i) + 1;
      if (column >= 0 && column < 3) row[column] += odd ? taps.odd_weight[k] : taps.weight[k];
    }
    const double pivot = row[1] - (i > 0 ? row[0] * after[i - 1] : 0.0);
    after[i] = row[2] / pivot;
    values[i] = (values[i] - (i > 0 ? row[0] * values[i - 1] : 0.0)) / pivot;
  }
  for (size_t i = theta.size() - 1; i-- > 0;) values[i] -= after[i] * values[i + 1];
}

namespace {

/// Chaikin's rule: the control values of a uniform quadratic B-spline whose intervals are cut in half.
std::vector<double> cut_corners(std::span<const double> control) {
  std::vector<double> finer;
  for (size_t i = 0; i + 1 < control.size(); ++i) {
    finer.push_back(0.75 * control[i] + 0.25 * control[i + 1]);
    finer.push_back(0.25 * control[i] + 0.75 * control[i + 1]);
  }
  return finer;
}

/// Applies cut_corners to each row of `width` values; the result is transposed.
std::vector<double> cut_rows(std::span<const double> control, size_t width) {
  const size_t rows = control.size() / width;
  std::vector<double> finer;
  for (size_t y = 0; y < rows; ++y) {
    const auto row = cut_corners(control.subspan(y * width, width));
    finer.resize(row.size() * rows);
    for (size_t x = 0; x < row.size(); ++x) finer[x * rows + y] = row[x];
  }
  return finer;
}

}  // namespace

std::vector<double> ViewSpline::halved(std::span<const double> control, bool odd) const {
  if (!isotropic_) {
    const auto width = static_cast<size_t>(side());
    return cut_rows(cut_rows(control, width), width);
  }
  if (!mirrored_) return cut_corners(control);
  std::vector<double> whole{odd ? -control[0] : control[0]};
  whole.insert(whole.end(), control.begin(), control.end());
  auto finer = cut_corners(whole);
  finer.erase(finer.begin());  // mirror image of the next value
  return finer;
}

double pole_fade(double theta_v) {
  const double x = theta_v / radians_from(2.5);
  return -std::expm1(-x * x);
}

}  // namespace velour
