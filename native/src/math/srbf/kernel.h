// The two kernels of spherical radial basis functions, in numerically stable forms (method: [T06];
// docs/engine/equations.md).
//
// A kernel depends only on d = 1 - eta . xi, 0 <= d <= 2. `d` must come from |eta - xi|^2 / 2, never from a
// subtraction of two numbers near one. Everything here is double; the float SIMD forms live in eval_mixture.cpp and are
// tested against these.
#pragma once

#include "math/sphere/vec.h"

namespace velour {

enum class Kernel {
  gaussian = 0,      // exp(-bandwidth d), bandwidth > 0: the shape of a von Mises-Fisher density
  abel_poisson = 1,  // (1 - b^2) (1 - 2 b t + b^2)^(-3/2), 0 < b < 1, t = 1 - d: Henyey-Greenstein times 4 pi
};

const char* kernel_name(Kernel kernel);

/// 1 - a . b of unit vectors without cancellation.
inline double one_minus_dot(const Vec3d& a, const Vec3d& b) {
  const Vec3d diff = a - b;
  return 0.5 * glm::dot(diff, diff);
}

/// Value G(d).
double kernel_value(Kernel kernel, double bandwidth, double d);
/// Integral of G over the sphere: (2 pi / l) (1 - exp(-2 l)) for the Gaussian (4 pi at l = 0), 4 pi for Abel-Poisson.
double kernel_integral(Kernel kernel, double bandwidth);
/// Inverse of the distribution of d for `u` in [0, 1): u = 0 gives d = 2 and u -> 1 gives d -> 0 for the Gaussian, and
/// likewise for Abel-Poisson. Exact closed forms; stays in [0, 2].
double kernel_sample(Kernel kernel, double bandwidth, double u);

/// 1 - mean cosine about the center of the Gaussian as a density, 1 - (coth(l) - 1 / l); and its inverse, between
/// kMinMeanBandwidth and kMaxMeanBandwidth. [BDGS05]
double gaussian_one_minus_mean(double bandwidth);
double gaussian_bandwidth_of_mean(double one_minus_mean);
inline constexpr double kMinMeanBandwidth = 0.05, kMaxMeanBandwidth = 1e7;

/// Integral over the sphere of the product of two kernels about unit `a` and `b`. Closed forms for two Gaussians (4 pi
/// e^(-la-lb) sinh(R)/R) and two Abel-Poisson kernels.
double kernel_convolution(Kernel kernel, const Vec3d& a, double bandwidth_a, const Vec3d& b, double bandwidth_b);

/// Pointwise product of two Gaussians = `scale` times one Gaussian. Opposite equal lobes give bandwidth 0, any center.
struct GaussianProduct {
  Vec3d center;
  double bandwidth;
  double scale;
};
GaussianProduct gaussian_product(const Vec3d& a, double bandwidth_a, const Vec3d& b, double bandwidth_b);

}  // namespace velour
