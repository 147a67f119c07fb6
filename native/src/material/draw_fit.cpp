#include "material/draw_fit.h"

#include <algorithm>
#include <cmath>

#include "material/light_points.h"
#include "srbf/kernel.h"

namespace velour {

namespace {

constexpr int kRounds = 2;  // of quadrature: each draws its points from the fit so far
constexpr int kIterations = 8;
/// Few points tell little of a lobe that hardly shows: its bandwidth is not believed beyond this factor.
constexpr double kMostSharpening = 16;

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
void improve(const LightPoints& points, std::span<const WarpedLobe> lobes, DrawFit& fit) {
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
      const double d = one_minus_dot(points.psi(i, j), fit.lobes[j].center);
      part[j] = norm[j] * std::exp(-fit.lobes[j].bandwidth * d) * points.jacobian(i, j);
      total += part[j];
    }
    const double scale = points.weight(i) / total;
    cosine += scale * cosine_part;
    for (size_t j = 0; j < count; ++j) {
      psi[j].add(scale * part[j], points.psi(i, j));
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
  DrawFit fit{0, 1, drawn_as_they_are(lobes)};
  for (int round = 0; round < kRounds; ++round) {
    const LightPoints points(lobes, fit.lobes, wv);
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
