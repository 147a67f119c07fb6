#include "material/light_points.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sphere/frame.h"
#include "sphere/warp.h"
#include "srbf/kernel.h"

namespace velour {

namespace {

constexpr int kZeniths = 8, kAzimuths = 8;

double luminance_of(const Vec3d& c) { return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z; }

/// Zeniths of equal probability, as 1 - cos, with the mean of the Gaussian itself.
std::vector<double> zeniths(double bandwidth) {
  std::vector<double> d;
  double sum = 0;
  for (int i = 0; i < kZeniths; ++i)
    sum += d.emplace_back(kernel_sample(Kernel::gaussian, bandwidth, (i + 0.5) / kZeniths));
  const double scale = kZeniths * gaussian_one_minus_mean(bandwidth) / sum;
  for (double& x : d) x = std::min(scale * x, 2.0);
  return d;
}

/// Within what draws may have.
double drawn_bandwidth(const WarpedLobe& lobe) {
  return std::clamp(lobe.bandwidth, kMinMeanBandwidth, kMaxMeanBandwidth);
}

void add_draws(const WarpedLobe& lobe, const Vec3d& wv, std::vector<Vec3d>& lights) {
  const Frame frame = Frame::about(Vec3(lobe.center));
  for (const double d : zeniths(drawn_bandwidth(lobe))) {
    const double sine = std::sqrt(d * (2 - d));
    for (int k = 0; k < kAzimuths; ++k) {
      const double phi = 2 * kPiD * (k + 0.5) / kAzimuths;
      const Vec3d across = std::cos(phi) * Vec3d(frame.x) + std::sin(phi) * Vec3d(frame.y);
      const auto wl = unwarped(lobe, glm::normalize(sine * across + (1 - d) * lobe.center), wv);
      if (wl && wl->z > 1e-6) lights.push_back(*wl);
    }
  }
}

void add_cosine_draws(std::vector<Vec3d>& lights) {
  for (int i = 0; i < kZeniths; ++i) {
    for (int k = 0; k < kAzimuths; ++k) {
      const Vec2 u((static_cast<float>(i) + 0.5f) / kZeniths, (static_cast<float>(k) + 0.5f) / kAzimuths);
      lights.emplace_back(sample_cosine_hemisphere(u));
    }
  }
}

}  // namespace

LightPoints::LightPoints(std::span<const WarpedLobe> lobes, const Vec3d& wv) : lobes_(lobes.size()) {
  for (const WarpedLobe& lobe : lobes) add_draws(lobe, wv, light_);
  add_cosine_draws(light_);
  for (const Vec3d& wl : light_) {
    double f = 0, density = wl.z / kPiD;
    for (const WarpedLobe& lobe : lobes) {
      const double d = one_minus_dot(warped(lobe, wl, wv), lobe.center), drawn = drawn_bandwidth(lobe);
      const double kernel = kernel_.emplace_back(kernel_value(Kernel::gaussian, lobe.bandwidth, d));
      const double drawn_kernel = drawn == lobe.bandwidth ? kernel : kernel_value(Kernel::gaussian, drawn, d);
      f += luminance_of(lobe.coefficient) * kernel;
      density += warp_jacobian(lobe, wl, wv) * drawn_kernel / kernel_integral(Kernel::gaussian, drawn);
    }
    value_.push_back(f);
    // Each component drew as many points: their joint density is the sum of theirs.
    weight_.push_back(f * wl.z / (density * kZeniths * kAzimuths));
  }
}

double LightPoints::mass() const { return std::accumulate(weight_.begin(), weight_.end(), 0.0); }

}  // namespace velour
