#include "realtime/light_gaussians.h"

#include <algorithm>
#include <cmath>

#include "math/sphere/frame.h"
#include "math/srbf/kernel.h"

namespace velour {
namespace {

constexpr double kMaxBandwidth = 1e6;
constexpr double kMinAbove = 1e-9;          // minimum share of a Gaussian above the horizon
constexpr double kBroad = 8, kNarrow = 24;  // bandwidths
constexpr double kRowSpacing = 1.8;         // in deviations of a Gaussian; the sum is smooth to one in two hundred

/// Gaussians in a row: positions x, in deviations of the Gaussian that they sample, and weights that sum to 1.
struct Row {
  explicit Row(size_t count) : n(static_cast<int>(count)) {
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += std::exp(-x(i) * x(i) / 2);
    for (int i = 0; i < n; ++i) variance += (share[i] = std::exp(-x(i) * x(i) / 2) / sum) * x(i) * x(i);
  }
  double x(int i) const { return n > 1 ? 4.0 * i / (n - 1) - 2 : 0; }
  /// Maximum variance of the positions, relative to that of each Gaussian, for a smooth sum.
  double most() const { return variance * std::pow(kRowSpacing * (n - 1) / 4, 2); }

  static constexpr int kMost = 13;
  int n;
  double share[kMost], variance = 0;
};

/// The light direction of the argument at `distance` from the lobe's center along `tangent`, if there is one.
std::optional<Vec3d> light_at(const WarpedLobe& lobe, const Vec3d& tangent, double distance, const Vec3d& wv) {
  const Vec3d psi = std::cos(distance) * lobe.center + std::sin(distance) * tangent;
  return unwarped(lobe, psi, wv);
}

/// Derivative of the light direction along `tangent`, from both sides of the center if both have light directions.
Vec3d spread(const WarpedLobe& lobe, const Vec3d& center, const Vec3d& tangent, double step, const Vec3d& wv) {
  const auto ahead = light_at(lobe, tangent, step, wv), behind = light_at(lobe, tangent, -step, wv);
  if (ahead && behind) return (*ahead - *behind) / (2 * step);
  if (ahead) return (*ahead - center) / step;
  if (behind) return (center - *behind) / step;
  return tangent;
}

/// Approximates a Gaussian times the clipped cosine by a Gaussian: its mean and variance along the normal become those
/// of a normal distribution of cosines, and `color` is multiplied by the mean cosine.
void multiply_by_cosine(LightGaussian& g) {
  const double m = g.center.z, s = std::sqrt(std::max(1 - m * m, 0.0) / g.bandwidth);
  if (s < 1e-6) {
    g.color *= std::max(m, 0.0);
    g.is_used = g.is_used && m > 0;
    return;
  }
  const double x = m / s, density = std::exp(-x * x / 2) / std::sqrt(2 * kPiD),
               above = 0.5 * std::erfc(-x / std::sqrt(2.0));
  const double first = s * density + m * above;  // moments of max(z, 0)
  const double second = (m * m + s * s) * above + m * s * density;
  const double third = (m * m + 2 * s * s) * s * density + m * (m * m + 3 * s * s) * above;
  if (!(first > kMinAbove)) {
    g.color = Vec3d(0.0);
    g.is_used = false;
    return;
  }
  const double mean = std::min(second / first, 1.0),
               variance = std::max(third / first - second / first * second / first, 0.1 * s * s);
  const double planar = std::sqrt((1 - mean * mean) / (1 - m * m));
  g.center = glm::normalize(Vec3d(planar * g.center.x, planar * g.center.y, mean));
  g.bandwidth = std::clamp(g.bandwidth * s / std::sqrt(variance), 1.0, kMaxBandwidth);
  g.color *= first;
}

void clip_at_horizon(LightGaussian& g) {
  const double deviation = std::sqrt(std::max(1 - g.center.z * g.center.z, 1e-12) / g.bandwidth);
  const double above = 0.5 * std::erfc(-g.center.z / deviation / std::sqrt(2.0));
  g.color *= above;
  g.is_used = g.is_used && above > kMinAbove;
}

/// Share of a lobe that becomes Gaussians. Broad lobes times the cosine are not Gaussian; BroadPart fits them.
double gaussian_share(double bandwidth) {
  const double t = std::clamp(std::log(bandwidth / kBroad) / std::log(kNarrow / kBroad), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace

ReachedLobe reached(const WarpedLobe& lobe, const Vec3d& wv) {
  return reached(lobe, glm::dmat2(1 / std::sqrt(lobe.bandwidth)), wv);
}

ReachedLobe reached(const WarpedLobe& lobe, const glm::dmat2& deviations, const Vec3d& wv) {
  ReachedLobe result{.lobe = lobe,
                     .reach = {},
                     .peak = lobe.coefficient,
                     .curvature = glm::inverse(deviations * glm::transpose(deviations))};
  const auto center = unwarped(lobe, lobe.center, wv);
  if (!center) return result;
  LobeReach& reach = result.reach;
  reach.is_seen = true;
  const Frame frame = Frame::about(Vec3(lobe.center));
  const Vec3d x(frame.x), y(frame.y);
  const double step = std::min(0.5 * std::sqrt(std::abs(glm::determinant(deviations))), 0.2);
  const glm::dmat2x3 light =
      glm::dmat2x3(spread(lobe, *center, x, step, wv), spread(lobe, *center, y, step, wv)) * deviations;
  // The longest axis of the ellipse to which the unit circle maps among lights.
  const double a = glm::dot(light[0], light[0]), b = glm::dot(light[0], light[1]), c = glm::dot(light[1], light[1]);
  const double middle = (a + c) / 2, half = std::hypot((a - c) / 2, b);
  const double turn = 0.5 * std::atan2(2 * b, a - c);
  const glm::dvec2 along = deviations * glm::dvec2(std::cos(turn), std::sin(turn));
  const double deviation = glm::length(along);
  result.lobe.bandwidth = 1 / (deviation * deviation);
  result.lobe.coefficient *= std::abs(glm::determinant(deviations)) * result.lobe.bandwidth;  // keeps the integral
  reach.along = (along.x * x + along.y * y) / deviation;
  reach.longer = std::sqrt(middle + half) / deviation;
  reach.shorter = std::sqrt(std::max(middle - half, 1e-4 * middle)) / deviation;
  return result;
}

Vec3d ReachedLobe::value(const Vec3d& wl, const Vec3d& wv) const {
  const Frame frame = Frame::about(Vec3(lobe.center));
  const Vec3d psi = warped(lobe, wl, wv);
  const glm::dvec2 plane(glm::dot(psi, Vec3d(frame.x)), glm::dot(psi, Vec3d(frame.y)));
  // Scaled to the length of the chord, so that a round lobe equals its kernel.
  const glm::dvec2 apart = plane * (glm::length(psi - lobe.center) / std::max(glm::length(plane), 1e-12));
  return peak * std::exp(-0.5 * glm::dot(apart, curvature * apart));
}

size_t gaussians_for(double ratio) {
  size_t n = 1;
  while (n < Row::kMost && ratio * ratio - 1 > Row(n).most() + 0.2) n += 2;
  return n;
}

void light_gaussians(const ReachedLobe& reached, LobeOf of, const Vec3d& wv, std::span<LightGaussian> out) {
  const WarpedLobe& lobe = reached.lobe;
  const LobeReach& reach = reached.reach;
  const Row row(out.size());
  // Along the row, the variance of the positions and that of each Gaussian add up to the lobe's; across, each has all.
  const double square = std::pow(reach.longer / reach.shorter, 2), places = std::min(square - 1, row.most());
  const double own = square / (1 + places);  // variance along over that across; above 1 if the row is too short
  const double deviation = std::sqrt(1 / lobe.bandwidth);  // of the argument
  const double spread = row.n > 1 ? deviation * std::sqrt(places / (1 + places) / row.variance) : 0;
  const double across = reached.bandwidth_across() / std::sqrt(own);
  const auto center = unwarped(lobe, lobe.center, wv);
  const double whole = kernel_integral(Kernel::gaussian, lobe.bandwidth), share = gaussian_share(across);
  for (int i = 0; i < row.n; ++i) {
    LightGaussian& g = out[static_cast<size_t>(i)] = {.bandwidth = std::clamp(across, 1.0, kMaxBandwidth)};
    const auto wl = center ? light_at(lobe, reach.along, row.x(i) * spread, wv) : std::nullopt;
    if (!wl) continue;
    const double area = 1 / warp_jacobian(lobe, *wl, wv), growth = area * warp_jacobian(lobe, *center, wv);
    g.is_used = share > 0;
    g.center = *wl;
    // The growth of half vectors is all across: the exact power is 2, and 1 keeps the row smooth along.
    g.bandwidth = std::clamp(across / std::pow(growth, 1.5), 1.0, kMaxBandwidth);
    g.color = share * whole * row.share[i] * area * lobe.coefficient;
    of == LobeOf::f ? multiply_by_cosine(g) : clip_at_horizon(g);
  }
}

Vec3d value_of(std::span<const LightGaussian> gaussians, const Vec3d& wl) {
  Vec3d sum(0.0);
  for (const LightGaussian& g : gaussians) {
    sum += g.color * (kernel_value(Kernel::gaussian, g.bandwidth, one_minus_dot(g.center, wl)) /
                      kernel_integral(Kernel::gaussian, g.bandwidth));
  }
  return sum;
}

}  // namespace velour
