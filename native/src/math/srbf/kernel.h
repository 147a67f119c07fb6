// The two kernels of spherical radial basis functions, in numerically stable forms (method: [T06];
// docs/engine/equations.md).
//
// A kernel depends only on d = 1 - eta . xi, 0 <= d <= 2. `d` must come from |eta - xi|^2 / 2, never from a
// subtraction of two numbers near one. Everything here is double; the float SIMD forms live in eval_mixture.cpp and are
// tested against these.
#pragma once

#include "math/sphere/vec.h"
#include "math/srbf/warped_lobe.h"

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

// Widening of lobes by convolution on the sphere, as on a rougher surface.

/// Bandwidth of the Gaussian over half vectors into which a roughness r in (0, 1] spreads a mirror: 2 / r^4. Near the
/// normal it approximates the facet distributions of Beckmann [BS63] and GGX [WMLT07] with alpha = r^2, i.e. with the
/// roughness r that artists use.
double half_bandwidth_of_roughness(double roughness);
/// Bandwidth over light directions, for a view of this cosine (> 0) to the facets: light directions cover 4 cosine
/// times the solid angle of their half vectors.
double light_bandwidth_of_roughness(double roughness, double cosine);

/// Bandwidth of a kernel convolved with the density of a Gaussian of bandwidth `by` (> 0, infinite: a mirror). Mean
/// cosines multiply under convolution on the sphere; the kernel of that mean cosine approximates the result, which is
/// Gaussian up to a small error and exactly Abel-Poisson if both are. Never above `bandwidth`.
double widened_bandwidth(Kernel kernel, double bandwidth, double by);

/// Convolves the lobe over its light directions or half vectors. Its peak stays in place, and in the tangent plane at
/// the normal its covariance grows by that of the density, equally in all directions, so a stretched lobe becomes
/// rounder. Without stretch this is widened_bandwidth(); with stretch and far from the normal, where lobes are bent, it
/// is a rough approximation. Bandwidth and stretch never grow. The coefficient stays the same.
WarpedLobe widened(const WarpedLobe& lobe, double by);

// Integrals of lobes over the upper hemisphere.

/// Integral over the upper hemisphere of a kernel whose center has this polar cosine, -1 to 1.
double kernel_integral_above(Kernel kernel, double bandwidth, double cosine);

/// Integral of a lobe's kernel times the cosine over light directions above the horizon, viewed from unit `wv`. Times
/// the coefficient it is the lobe's part of the directional albedo. The relative error is 1e-3 for most lobes and 1e-2
/// where the horizon cuts off most of the lobe.
double reflected_light(const WarpedLobe& lobe, const Vec3d& wv);

}  // namespace velour
