#include "srbf/warped_lobe.h"

#include <cmath>

#include "srbf/kernel.h"

namespace velour {
namespace {

Vec3d argument(LobeSpace space, const Vec3d& wl, const Vec3d& wv) { return space == LobeSpace::half ? wl + wv : wl; }

Vec3d stretched(const Stretch& s, const Vec3d& y) { return {s.xx * y.x + s.xy * y.y, s.xy * y.x + s.yy * y.y, y.z}; }

}  // namespace

Stretch stretch_from(double a, double b) {
  const double m = std::hypot(a, b);
  const double c = std::cosh(m), s = m > 1e-8 ? std::sinh(m) / m : 1.0;
  return {c - s * a, s * b, c + s * a};
}

Vec3d tilted_normal(double tilt_x, double tilt_y) {
  const double angle = std::hypot(tilt_x, tilt_y);
  const double s = angle > 1e-8 ? std::sin(angle) / angle : 1.0;
  return {s * tilt_x, s * tilt_y, std::cos(angle)};
}

Vec3d warped(const WarpedLobe& lobe, const Vec3d& wl, const Vec3d& wv) {
  return glm::normalize(stretched(lobe.stretch, argument(lobe.space, wl, wv)));
}

std::optional<Vec3d> unwarped(const WarpedLobe& lobe, const Vec3d& psi, const Vec3d& wv) {
  // The inverse of a symmetric matrix of determinant 1.
  const Stretch inverse{lobe.stretch.yy, -lobe.stretch.xy, lobe.stretch.xx};
  const Vec3d eta = glm::normalize(stretched(inverse, psi));
  if (lobe.space == LobeSpace::light) return eta;
  const double cosine = glm::dot(eta, wv);
  if (cosine <= 0) return std::nullopt;
  return 2 * cosine * eta - wv;
}

double warp_jacobian(const WarpedLobe& lobe, const Vec3d& wl, const Vec3d& wv) {
  const Vec3d y = argument(lobe.space, wl, wv);
  const double length = glm::length(stretched(lobe.stretch, y));
  const double cube = length * length * length;
  return (lobe.space == LobeSpace::half ? glm::dot(y, y) / 2 : 1.0) / cube;
}

double warped_kernel(const WarpedLobe& lobe, const Vec3d& wl, const Vec3d& wv) {
  return kernel_value(Kernel::gaussian, lobe.bandwidth, one_minus_dot(warped(lobe, wl, wv), lobe.center));
}

}  // namespace velour
