#include "material/drawn_lobe.h"

#include <algorithm>
#include <vector>

#include "sphere/frame.h"
#include "srbf/kernel.h"

namespace velour {

namespace {

constexpr int kZeniths = 12, kAzimuths = 12;

/// A Gaussian by the sum of weighted directions.
struct Moments {
  double weight = 0;
  Vec3d sum{0};
  void add(double w, const Vec3d& direction) {
    weight += w;
    sum += w * direction;
  }
  Vec3d center() const { return glm::normalize(sum); }
  double bandwidth() const { return gaussian_bandwidth_of_mean(1 - glm::length(sum) / weight); }
};

/// psi drawn from the lobe, and the ratio of f cos to the lobe in that space.
struct Draw {
  Vec3d psi, wl;
  double ratio;
};

std::vector<Draw> draws_of(const WarpedLobe& lobe, const Vec3d& wv) {
  const Frame frame = Frame::about(Vec3(lobe.center));
  std::vector<Draw> draws;
  for (int i = 0; i < kZeniths; ++i) {
    const double d = kernel_sample(Kernel::gaussian, lobe.bandwidth, (i + 0.5) / kZeniths);
    const double sine = std::sqrt(d * (2 - d));
    for (int k = 0; k < kAzimuths; ++k) {
      const double phi = 2 * kPiD * (k + 0.5) / kAzimuths;
      const Vec3d psi = glm::normalize(sine * std::cos(phi) * Vec3d(frame.x) + sine * std::sin(phi) * Vec3d(frame.y) +
                                       (1 - d) * lobe.center);
      const auto wl = unwarped(lobe, psi, wv);
      const double ratio = wl && wl->z > 0 ? wl->z / warp_jacobian(lobe, *wl, wv) : 0.0;
      draws.push_back({psi, wl.value_or(Vec3d(0, 0, -1)), ratio});
    }
  }
  return draws;
}

/// Second moments of f cos over a density, but for factors that all densities share.
double spread_under_cosine(const WarpedLobe& lobe, const std::vector<Draw>& draws) {
  double sum = 0;
  for (const Draw& draw : draws) {
    sum += draw.ratio * kernel_value(Kernel::gaussian, lobe.bandwidth, one_minus_dot(draw.psi, lobe.center));
  }
  return kPiD * sum;
}

double spread_under(const Vec3d& center, double bandwidth, const WarpedLobe& lobe, const std::vector<Draw>& draws) {
  double sum = 0;
  for (const Draw& draw : draws) {
    const double exponent =
        bandwidth * one_minus_dot(draw.psi, center) - lobe.bandwidth * one_minus_dot(draw.psi, lobe.center);
    sum += draw.ratio * draw.ratio * std::exp(std::min(exponent, 600.0));
  }
  return kernel_integral(Kernel::gaussian, bandwidth) * sum;
}

}  // namespace

DrawnLobe drawn_lobe(const WarpedLobe& lobe, const Vec3d& wv) {
  const std::vector<Draw> draws = draws_of(lobe, wv);
  Moments plain, drawn, light;
  for (const Draw& draw : draws) {
    plain.add(1, draw.psi);
    drawn.add(draw.ratio, draw.psi);
    light.add(draw.ratio, draw.wl);
  }
  if (drawn.weight <= 0) return {0, false, lobe.center, lobe.bandwidth, {0, 0, 1}, 1};
  const double mean_ratio = drawn.weight / static_cast<double>(draws.size());
  const double luminance = 0.2126 * lobe.coefficient.x + 0.7152 * lobe.coefficient.y + 0.0722 * lobe.coefficient.z;
  DrawnLobe result;
  result.mass = luminance * mean_ratio * kernel_integral(Kernel::gaussian, lobe.bandwidth);
  // The quotient takes out what so few zeniths miss of the lobe itself.
  result.center = drawn.center();
  result.bandwidth =
      std::clamp(lobe.bandwidth * drawn.bandwidth() / plain.bandwidth(), kMinMeanBandwidth, kMaxMeanBandwidth);
  result.light_center = light.center();
  result.light_bandwidth = light.bandwidth();
  result.is_cosine = spread_under_cosine(lobe, draws) <= spread_under(result.center, result.bandwidth, lobe, draws);
  return result;
}

}  // namespace velour
