#include "math/srbf/widened_lobe.h"

#include <algorithm>
#include <cmath>
#include "math/sphere/frame.h"

namespace velour {

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

double reflected_light(const WarpedLobe& lobe, const Vec3d& wv) {
  const Frame frame = Frame::about(Vec3(lobe.center));
  const double integral = kernel_integral(Kernel::gaussian, lobe.bandwidth);
  double sum = 0;
  const auto add = [&](const Vec3d& wl) {
    const double kernel = warped_kernel(lobe, wl, wv), cosine = wl.z;
    sum += kernel * cosine / (kernel * warp_jacobian(lobe, wl, wv) / integral + cosine / kPiD);
  };
  for (int i = 0; i < kDraws; ++i) {  // a Fibonacci lattice samples both the lobe and the cosine
    const double u = (i + 0.5) / kDraws, phi = 2 * kPiD * std::fmod(i * kGoldenRatio, 1.0);
    const double c = std::cos(phi), s = std::sin(phi);
    const double d = kernel_sample(Kernel::gaussian, lobe.bandwidth, u), sine = std::sqrt(d * (2 - d));
    const Vec3d psi = sine * (c * Vec3d(frame.x) + s * Vec3d(frame.y)) + (1 - d) * lobe.center;
    const auto wl = unwarped(lobe, glm::normalize(psi), wv);
    if (wl && wl->z > 0) add(*wl);
    add({std::sqrt(u) * c, std::sqrt(u) * s, std::sqrt(1 - u)});
  }
  return sum / kDraws;
}

}  // namespace velour
