#include "math/srbf/warped_lobe.h"

#include <cmath>

#include "math/srbf/kernel.h"

namespace velour {
namespace {

Vec3d argument(LobeSpace space, const Vec3d& wl, const Vec3d& wv) { return space == LobeSpace::half ? wl + wv : wl; }

Vec3d scaled(const Stretch& s, const Vec3d& y) { return {s.xx * y.x + s.xy * y.y, s.xy * y.x + s.yy * y.y, y.z}; }

}  // namespace

Vec3d stretched(const Stretch& s, const Vec3d& y) { return glm::normalize(scaled(s, y)); }

Stretch stretch_from(double a, double b) {
  const double m = std::hypot(a, b);
  const double c = std::cosh(m), s = m > 1e-8 ? std::sinh(m) / m : 1.0;
  return {c - s * a, s * b, c + s * a};
}

glm::dvec2 exponents_of(const Stretch& stretch) {
  const glm::dvec2 sines(0.5 * (stretch.yy - stretch.xx), stretch.xy);  // sinh(m) / m times (a, b)
  const double length = glm::length(sines);
  return length > 1e-8 ? std::asinh(length) / length * sines : sines;
}

StretchSlopes stretch_slopes(double a, double b) {
  // S = cosh(m) + q M, M = [[-a, b], [b, a]], q = sinh(m) / m.
  const double m_sq = a * a + b * b, m = std::sqrt(m_sq);
  const double c = std::cosh(m), q = m > 1e-4 ? std::sinh(m) / m : 1 + m_sq / 6;
  const double k = m > 1e-4 ? (c - q) / m_sq : 1.0 / 3;
  return {{(q + k * -a) * a - q, k * a * b, (q + k * a) * a + q}, {(q + k * -a) * b, k * b * b + q, (q + k * a) * b}};
}

TiltSlopes tilt_slopes(double tilt_x, double tilt_y) {
  const double t_sq = tilt_x * tilt_x + tilt_y * tilt_y, t = std::sqrt(t_sq);
  const double s = t > 1e-4 ? std::sin(t) / t : 1 - t_sq / 6;
  const double k = t > 1e-4 ? (std::cos(t) - s) / t_sq : -1.0 / 3;
  return {{s + k * tilt_x * tilt_x, k * tilt_x * tilt_y, -s * tilt_x},
          {k * tilt_x * tilt_y, s + k * tilt_y * tilt_y, -s * tilt_y}};
}

Vec3d tilted_normal(double tilt_x, double tilt_y) {
  const double angle = std::hypot(tilt_x, tilt_y);
  const double s = angle > 1e-8 ? std::sin(angle) / angle : 1.0;
  return {s * tilt_x, s * tilt_y, std::cos(angle)};
}

glm::dvec2 tilt_of(const Vec3d& center) {
  const double sine = std::hypot(center.x, center.y);
  const double scale = sine > 1e-8 ? std::atan2(sine, center.z) / sine : 1.0;
  return scale * glm::dvec2(center.x, center.y);
}

Vec3d warped(const WarpedLobe& lobe, const Vec3d& wl, const Vec3d& wv) {
  return stretched(lobe.stretch, argument(lobe.space, wl, wv));
}

Vec3d argument_at(const WarpedLobe& lobe, const Vec3d& psi) {
  // The inverse of a symmetric matrix of determinant 1.
  const Stretch inverse{lobe.stretch.yy, -lobe.stretch.xy, lobe.stretch.xx};
  return stretched(inverse, psi);
}

std::optional<Vec3d> unwarped(const WarpedLobe& lobe, const Vec3d& psi, const Vec3d& wv) {
  const Vec3d eta = argument_at(lobe, psi);
  if (lobe.space == LobeSpace::light) return eta;
  const double cosine = glm::dot(eta, wv);
  if (cosine <= 0) return std::nullopt;
  return 2 * cosine * eta - wv;
}

double warp_jacobian(const WarpedLobe& lobe, const Vec3d& wl, const Vec3d& wv) {
  const Vec3d y = argument(lobe.space, wl, wv);
  const double length = glm::length(scaled(lobe.stretch, y));
  const double cube = length * length * length;
  return (lobe.space == LobeSpace::half ? glm::dot(y, y) / 2 : 1.0) / cube;
}

double warped_kernel(const WarpedLobe& lobe, const Vec3d& wl, const Vec3d& wv) {
  return kernel_value(Kernel::gaussian, lobe.bandwidth, one_minus_dot(warped(lobe, wl, wv), lobe.center));
}

}  // namespace velour
