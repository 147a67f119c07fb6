#include "math/srbf/kernel.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "math/sphere/frame.h"

namespace velour {

namespace {

/// D = 1 - 2 b t + b^2 with t = 1 - d, as a sum of two non-negative terms.
double abel_poisson_denominator(double b, double d) { return (1 - b) * (1 - b) + 2 * b * d; }

double abel_poisson_value(double b, double d) {
  const double denominator = abel_poisson_denominator(b, d);
  return (1 - b) * (1 + b) / (denominator * std::sqrt(denominator));
}

/// d = -log(u + (1 - u) e^-2l) / l, method 6.2. Broad lobes need expm1 and log1p for precision where the logarithm is
/// near 0; the others use plain exp and log, which cost a third.
double gaussian_sample(double l, double u) {
  if (l == 0) return 2 * (1 - u);
  if (l < 1) return -std::log1p((1 - u) * std::expm1(-2 * l)) / l;
  return -std::log(u + (1 - u) * std::exp(-2 * l)) / l;
}

/// Method 6.2 with S - (1 - b) expanded, so that d stays precise near the center.
double abel_poisson_sample(double b, double u) {
  const double split = (1 - b) + 2 * b * u;
  const double s = (1 - b) * (1 + b) / split;
  return (1 - b) * (1 - u) / split * (s + (1 - b));
}

/// |la a + lb b| as a sum of squares, accurate for both opposite and equal centers.
double product_bandwidth(const Vec3d& a, double la, const Vec3d& b, double lb) {
  const Vec3d sum = a + b;
  return std::sqrt((la - lb) * (la - lb) + la * lb * glm::dot(sum, sum));
}

/// exp(R - la - lb), method 2.3.
double product_scale(const Vec3d& a, double la, const Vec3d& b, double lb, double r) {
  const double total = r + la + lb;
  return total > 0 ? std::exp(-2 * la * lb * one_minus_dot(a, b) / total) : 1.0;
}

}  // namespace

const char* kernel_name(Kernel kernel) { return kernel == Kernel::gaussian ? "gaussian" : "abel-poisson"; }

double kernel_value(Kernel kernel, double bandwidth, double d) {
  return kernel == Kernel::gaussian ? std::exp(-bandwidth * d) : abel_poisson_value(bandwidth, d);
}

double kernel_integral(Kernel kernel, double bandwidth) {
  if (kernel == Kernel::abel_poisson || bandwidth == 0) return 4 * kPiD;
  return -2 * kPiD * std::expm1(-2 * bandwidth) / bandwidth;
}

double kernel_sample(Kernel kernel, double bandwidth, double u) {
  const double d = kernel == Kernel::gaussian ? gaussian_sample(bandwidth, u) : abel_poisson_sample(bandwidth, u);
  return std::clamp(d, 0.0, 2.0);
}

double gaussian_one_minus_mean(double l) {
  if (l > 20) return 1 / l;  // exact up to e^-2l
  if (l < 1e-3) return 1 - l / 3;
  return 1 + 1 / l - 1 / std::tanh(l);
}

double gaussian_bandwidth_of_mean(double one_minus_mean) {
  const double m = std::clamp(one_minus_mean, 1e-9, 1.0);
  if (m < 0.02) return std::min(1 / m, kMaxMeanBandwidth);
  const double mean = 1 - m;
  double l = std::max(mean * (3 - mean * mean) / (m * (2 - m)), kMinMeanBandwidth);  // [BDGS05, eq. 4.4], then Newton
  for (int i = 0; i < 4; ++i) {
    const double coth = 1 / std::tanh(l), slope = 1 - coth * coth + 1 / (l * l);
    if (slope > 1e-9)
      l = std::clamp(l - (m - gaussian_one_minus_mean(l)) / slope, kMinMeanBandwidth, kMaxMeanBandwidth);
  }
  return l;
}

double kernel_convolution(Kernel kernel, const Vec3d& a, double bandwidth_a, const Vec3d& b, double bandwidth_b) {
  if (kernel == Kernel::abel_poisson) {
    return 4 * kPiD * abel_poisson_value(bandwidth_a * bandwidth_b, one_minus_dot(a, b));
  }
  const double r = product_bandwidth(a, bandwidth_a, b, bandwidth_b);
  return product_scale(a, bandwidth_a, b, bandwidth_b, r) * kernel_integral(Kernel::gaussian, r);
}

GaussianProduct gaussian_product(const Vec3d& a, double bandwidth_a, const Vec3d& b, double bandwidth_b) {
  const Vec3d sum = bandwidth_a * a + bandwidth_b * b;
  const double length = glm::length(sum);
  const double r = product_bandwidth(a, bandwidth_a, b, bandwidth_b);
  return {length > 0 ? sum / length : a, r, product_scale(a, bandwidth_a, b, bandwidth_b, r)};
}

namespace {

/// Square root of a positive symmetric matrix of determinant 1.
Stretch root_of(const Stretch& square) {
  const double scale = 1 / std::sqrt(square.xx + square.yy + 2);
  return {scale * (square.xx + 1), scale * square.xy, scale * (square.yy + 1)};
}

/// Inverse of gaussian_one_minus_mean for any mean cosine; below kMinMeanBandwidth by the series l / 3 - l^3 / 45.
double bandwidth_of_mean(double one_minus_mean) {
  const double mean = 1 - one_minus_mean;
  if (mean < kMinMeanBandwidth / 3) return 3 * mean * (1 + 0.6 * mean * mean);
  return one_minus_mean < 1 / kMaxMeanBandwidth ? 1 / one_minus_mean : gaussian_bandwidth_of_mean(one_minus_mean);
}

}  // namespace

double half_bandwidth_of_roughness(double roughness) {
  const double alpha = roughness * roughness;
  return 2 / (alpha * alpha);
}

double light_bandwidth_of_roughness(double roughness, double cosine) {
  return half_bandwidth_of_roughness(roughness) / (4 * cosine);
}

double widened_bandwidth(Kernel kernel, double bandwidth, double by) {
  const double added = gaussian_one_minus_mean(by);
  if (kernel == Kernel::abel_poisson) return bandwidth * (1 - added);  // its bandwidth is its mean cosine
  const double own = gaussian_one_minus_mean(bandwidth);
  return std::min(bandwidth_of_mean(own + added - own * added), bandwidth);
}

WarpedLobe widened(const WarpedLobe& lobe, double by) {
  const double before = 1 / lobe.bandwidth;
  const double added = std::max(1 / widened_bandwidth(Kernel::gaussian, lobe.bandwidth, by) - before, 0.0);
  // The covariance in the tangent plane, S^-2 / bandwidth, grows.
  const Stretch& s = lobe.stretch;
  const double xx = before * (s.yy * s.yy + s.xy * s.xy) + added, yy = before * (s.xx * s.xx + s.xy * s.xy) + added;
  const double xy = -before * s.xy * (s.xx + s.yy);
  WarpedLobe wider = lobe;
  wider.bandwidth = 1 / std::sqrt(xx * yy - xy * xy);
  wider.stretch = root_of({wider.bandwidth * yy, -wider.bandwidth * xy, wider.bandwidth * xx});
  wider.center = stretched(wider.stretch, argument_at(lobe, lobe.center));
  return wider;
}

namespace {

constexpr int kZeniths = 256, kDraws = 377;

/// Share above the horizon of the directions at angle `zenith` from a center (both given by sine and cosine).
double share_above(const glm::dvec2& center, const glm::dvec2& zenith) {
  const double needed = -center.y * zenith.y, reach = center.x * zenith.x;
  if (needed <= -reach) return 1;
  if (needed >= reach) return 0;
  return std::acos(needed / reach) / kPiD;
}

}  // namespace

double kernel_integral_above(Kernel kernel, double bandwidth, double cosine) {
  const glm::dvec2 center(std::sqrt(std::max(1 - cosine * cosine, 0.0)), cosine);
  double sum = 0;
  for (int i = 0; i < kZeniths; ++i) {
    const double d = kernel_sample(kernel, bandwidth, (i + 0.5) / kZeniths);
    sum += share_above(center, {std::sqrt(d * (2 - d)), 1 - d});
  }
  return kernel_integral(kernel, bandwidth) * sum / kZeniths;
}

namespace {

struct LatticePoint {
  double u, cosine, sine;  // of the azimuth
  double radius, height;   // of the direction that it samples from the cosine
};

/// A Fibonacci lattice.
const std::array<LatticePoint, kDraws>& lattice() {
  static const auto points = [] {
    std::array<LatticePoint, kDraws> made;
    for (int i = 0; i < kDraws; ++i) {
      const double u = (i + 0.5) / kDraws, phi = 2 * kPiD * std::fmod(i * kGoldenRatio, 1.0);
      made[static_cast<size_t>(i)] = {u, std::cos(phi), std::sin(phi), std::sqrt(u), std::sqrt(1 - u)};
    }
    return made;
  }();
  return points;
}

/// Integrand over the sum of both densities. `jacobian`: warp_jacobian().
double weighed(double kernel, double cosine, double jacobian, double integral) {
  return kernel * cosine / (kernel * jacobian / integral + cosine / kPiD);
}

/// weighed() at the light direction of a unit `psi`, whose kernel is known. With v = S^-1 psi, |S v / |v|| is 1 / |v|.
double weighed_at(const WarpedLobe& lobe, const Vec3d& psi, double kernel, double integral, const Vec3d& wv) {
  const Stretch& s = lobe.stretch;
  const Vec3d v(s.yy * psi.x - s.xy * psi.y, s.xx * psi.y - s.xy * psi.x, psi.z);
  const double length = glm::length(v), cube = length * length * length;
  const Vec3d eta = v / length;
  if (lobe.space == LobeSpace::light) return eta.z > 0 ? weighed(kernel, eta.z, cube, integral) : 0.0;
  const double cosine = glm::dot(eta, wv), height = 2 * cosine * eta.z - wv.z;
  return cosine > 0 && height > 0 ? weighed(kernel, height, cube / (4 * cosine), integral) : 0.0;
}

}  // namespace

double reflected_light(const WarpedLobe& lobe, const Vec3d& wv) {
  const Frame frame = Frame::about(Vec3(lobe.center));
  const Vec3d x(frame.x), y(frame.y);
  const double integral = kernel_integral(Kernel::gaussian, lobe.bandwidth), least = std::exp(-2 * lobe.bandwidth);
  double sum = 0;
  for (const LatticePoint& p : lattice()) {  // samples both the lobe and the cosine
    const double d = kernel_sample(Kernel::gaussian, lobe.bandwidth, p.u), sine = std::sqrt(d * (2 - d));
    const Vec3d psi = sine * (p.cosine * x + p.sine * y) + (1 - d) * lobe.center;
    sum += weighed_at(lobe, psi, p.u + (1 - p.u) * least, integral, wv);
    const Vec3d wl(p.radius * p.cosine, p.radius * p.sine, p.height);
    sum += weighed(warped_kernel(lobe, wl, wv), wl.z, warp_jacobian(lobe, wl, wv), integral);
  }
  return sum / kDraws;
}

}  // namespace velour
