#include "capture/reflectance.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "brdf/spectrum.h"

namespace velour {

double fresnel_reflectance(const RefractiveIndex& index, double cos_theta) {
  const double cos_sq = cos_theta * cos_theta, sin_sq = 1.0 - cos_sq;
  const double n_sq = index.n * index.n, k_sq = index.k * index.k;
  // With a + i b the complex cosine inside the metal times its index: modulus = a^2 + b^2, two_a_cos = 2 a cos_theta.
  const double t = n_sq - k_sq - sin_sq;
  const double modulus = std::sqrt(t * t + 4.0 * n_sq * k_sq);
  const double two_a_cos = 2.0 * cos_theta * std::sqrt(std::max(0.5 * (modulus + t), 0.0));
  const double perpendicular = (modulus + cos_sq - two_a_cos) / (modulus + cos_sq + two_a_cos);
  const double along = modulus * cos_sq + sin_sq * sin_sq, cross = two_a_cos * sin_sq;
  return 0.5 * perpendicular * (1.0 + (along - cross) / (along + cross));
}

Reflectance::Reflectance(const RefractiveIndex& index)
    : Reflectance(std::array{550.0}, std::array{index}) {}  // a spectrum is constant outside its samples

Reflectance::Reflectance(std::span<const double> wavelengths, std::span<const RefractiveIndex> indices) {
  const std::vector<Vec3d> weights = rec709_weights(wavelengths);
  std::vector<float> spectrum(indices.size());
  for (size_t node = 0; node <= kSteps; ++node) {
    const double cos_theta = static_cast<double>(node) / static_cast<double>(kSteps);
    std::transform(indices.begin(), indices.end(), spectrum.begin(), [&](const RefractiveIndex& index) {
      return static_cast<float>(fresnel_reflectance(index, cos_theta));
    });
    nodes_[node] = glm::clamp(rec709_of(weights, spectrum), 0.0f, 1.0f);
  }
}

}  // namespace velour
