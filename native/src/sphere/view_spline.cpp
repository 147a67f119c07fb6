#include "sphere/view_spline.h"

#include <cmath>

namespace velour {

PolarView<double> polar_view(const Vec3d& wv) {
  const double sine = std::hypot(wv.x, wv.y);
  if (sine == 0) return {0, 1, 0};
  return {std::atan2(sine, wv.z), wv.x / sine, wv.y / sine};
}

double pole_fade(double theta_v) {
  const double x = theta_v / radians_from(2.5);
  return -std::expm1(-x * x);
}

}  // namespace velour
