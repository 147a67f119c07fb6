#include "material/draw_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sphere/frame.h"
#include "sphere/warp.h"
#include "srbf/kernel.h"

namespace velour {

namespace {

constexpr int kZeniths = 8, kAzimuths = 8;
constexpr int kRounds = 2;  // of quadrature: each draws its points from the fit so far
constexpr int kIterations = 8;
/// Few points tell little of a lobe that hardly shows: its bandwidth is not believed beyond this factor.
constexpr double kMostSharpening = 16;

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

/// Draws of `drawn`, in the parameterisation of `lobe`.
void add_draws(const WarpedLobe& lobe, const DrawnLobe& drawn, const Vec3d& wv, std::vector<Vec3d>& lights) {
  const Frame frame = Frame::about(Vec3(drawn.center));
  for (const double d : zeniths(drawn.bandwidth)) {
    const double sine = std::sqrt(d * (2 - d));
    for (int k = 0; k < kAzimuths; ++k) {
      const double phi = 2 * kPiD * (k + 0.5) / kAzimuths;
      const Vec3d across = std::cos(phi) * Vec3d(frame.x) + std::sin(phi) * Vec3d(frame.y);
      const auto wl = unwarped(lobe, glm::normalize(sine * across + (1 - d) * drawn.center), wv);
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

/// The quadrature points, and what each lobe sees of them.
class Points {
 public:
  Points(std::span<const WarpedLobe> lobes, std::span<const DrawnLobe> drawn, const Vec3d& wv) {
    for (size_t j = 0; j < lobes.size(); ++j) add_draws(lobes[j], drawn[j], wv, light_);
    add_cosine_draws(light_);
    for (const Vec3d& wl : light_) {
      double f = 0, density = wl.z / kPiD;
      for (size_t j = 0; j < lobes.size(); ++j) {
        const Vec3d& psi = psi_.emplace_back(warped(lobes[j], wl, wv));
        const double jacobian = jacobian_.emplace_back(warp_jacobian(lobes[j], wl, wv));
        const auto kernel = [&](const auto& lobe) {
          return kernel_value(Kernel::gaussian, lobe.bandwidth, one_minus_dot(psi, lobe.center));
        };
        f += luminance_of(lobes[j].coefficient) * kernel(lobes[j]);
        density += jacobian * kernel(drawn[j]) / kernel_integral(Kernel::gaussian, drawn[j].bandwidth);
      }
      // Each component drew as many points: their joint density is the sum of theirs.
      weight_.push_back(f * wl.z / (density * kZeniths * kAzimuths));
    }
  }

  size_t size() const { return light_.size(); }
  double mass() const { return std::accumulate(weight_.begin(), weight_.end(), 0.0); }
  const Vec3d& light(size_t i) const { return light_[i]; }
  double weight(size_t i) const { return weight_[i]; }  // sum over the points: the integral of f cos
  const Vec3d& psi(size_t i, size_t lobe, size_t lobes) const { return psi_[i * lobes + lobe]; }
  double jacobian(size_t i, size_t lobe, size_t lobes) const { return jacobian_[i * lobes + lobe]; }

 private:
  std::vector<Vec3d> light_, psi_;
  std::vector<double> weight_, jacobian_;
};

/// Weighted directions and the Gaussian of the greatest likelihood for them.
struct Moments {
  double weight = 0;
  Vec3d sum{0};
  void add(double w, const Vec3d& direction) {
    weight += w;
    sum += w * direction;
  }
  double bandwidth() const { return gaussian_bandwidth_of_mean(1 - glm::length(sum) / weight); }
};

/// One step; the light-space Gaussians are a by-product.
void improve(const Points& points, std::span<const WarpedLobe> lobes, DrawFit& fit) {
  const size_t count = lobes.size();
  std::vector<Moments> psi(count), light(count);
  std::vector<double> part(count), norm(count);
  for (size_t j = 0; j < count; ++j) {
    norm[j] = fit.lobes[j].probability / kernel_integral(Kernel::gaussian, fit.lobes[j].bandwidth);
  }
  double cosine = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const double cosine_part = fit.cosine * points.light(i).z / kPiD;
    double total = cosine_part;
    for (size_t j = 0; j < count; ++j) {
      const double d = one_minus_dot(points.psi(i, j, count), fit.lobes[j].center);
      part[j] = norm[j] * std::exp(-fit.lobes[j].bandwidth * d) * points.jacobian(i, j, count);
      total += part[j];
    }
    const double scale = points.weight(i) / total;
    cosine += scale * cosine_part;
    for (size_t j = 0; j < count; ++j) {
      psi[j].add(scale * part[j], points.psi(i, j, count));
      light[j].add(scale * part[j], points.light(i));
    }
  }
  fit.cosine = cosine / fit.mass;
  for (size_t j = 0; j < count; ++j) {
    DrawnLobe& lobe = fit.lobes[j];
    lobe.probability = psi[j].weight / fit.mass;
    if (!(lobe.probability > 1e-9)) continue;
    lobe.center = glm::normalize(psi[j].sum);
    lobe.bandwidth = std::min(psi[j].bandwidth(), kMostSharpening * std::max(lobes[j].bandwidth, 1.0));
    lobe.light_center = glm::normalize(light[j].sum);
    lobe.light_bandwidth = light[j].bandwidth();
  }
}

}  // namespace

DrawFit fit_draws(std::span<const WarpedLobe> lobes, const Vec3d& wv) {
  DrawFit fit{0, 1, {}};
  for (const WarpedLobe& lobe : lobes) {
    const double bandwidth = std::clamp(lobe.bandwidth, kMinMeanBandwidth, kMaxMeanBandwidth);
    fit.lobes.push_back({0, lobe.center, bandwidth, {0, 0, 1}, 1});
  }
  for (int round = 0; round < kRounds; ++round) {
    const Points points(lobes, fit.lobes, wv);
    fit.mass = points.mass();
    if (!(fit.mass > 0)) return fit;
    if (round == 0) {
      fit.cosine = 1 / (static_cast<double>(lobes.size()) + 1);
      for (DrawnLobe& lobe : fit.lobes) lobe.probability = fit.cosine;
    }
    for (int i = 0; i < kIterations; ++i) improve(points, lobes, fit);
  }
  return fit;
}

}  // namespace velour
