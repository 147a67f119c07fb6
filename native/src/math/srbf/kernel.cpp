#include "math/srbf/kernel.h"

#include <algorithm>
#include <cmath>

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

}  // namespace velour
