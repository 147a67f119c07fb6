#include "srbf/widened_lobe.h"

#include <algorithm>
#include <cmath>

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

}  // namespace velour
