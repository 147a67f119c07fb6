// Widening of lobes by convolution on the sphere, as on a rougher surface.
#pragma once

#include "math/srbf/kernel.h"
#include "math/srbf/warped_lobe.h"

namespace velour {

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
