// Lobes made wider, as a rougher surface makes them: convolved on the sphere.
#pragma once

#include "srbf/kernel.h"
#include "srbf/warped_lobe.h"

namespace velour {

/// Bandwidth of the Gaussian over half vectors that a roughness r in (0, 1] spreads a mirror to: 2 / r^4. About the
/// normal it is the distribution of Beckmann's facets [BS63], and of GGX's [WMLT07], of alpha = r^2: what artists know
/// as a roughness of r.
double half_bandwidth_of_roughness(double roughness);
/// The same over light directions, for a view of this cosine (> 0) to the facets: a solid angle of half vectors is
/// 4 cos of them among lights.
double light_bandwidth_of_roughness(double roughness, double cosine);

/// Bandwidth of a kernel that is convolved with the density of a Gaussian of bandwidth `by` (> 0, infinite: a mirror).
/// Mean cosines multiply under convolution on the sphere; the kernel of that mean cosine stands for the result, which
/// is Gaussian up to a small error and exactly Abel-Poisson where both are. Never above `bandwidth`.
double widened_bandwidth(Kernel kernel, double bandwidth, double by);

/// The lobe convolved, over what it is a lobe of (light directions or half vectors): there its peak stays where it is,
/// and in the tangent plane at the normal its covariance grows by that of the density, alike in all directions; so a
/// stretched lobe becomes rounder. Without stretch it is widened_bandwidth(); with stretch and far from the normal,
/// where lobes are bent, it is rough. Bandwidth and stretch never grow. The coefficient stays.
WarpedLobe widened(const WarpedLobe& lobe, double by);

}  // namespace velour
