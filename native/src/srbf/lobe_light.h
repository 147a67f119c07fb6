// Integrals of lobes over the upper hemisphere.
#pragma once

#include "srbf/kernel.h"
#include "srbf/warped_lobe.h"

namespace velour {

/// Integral over the upper hemisphere of a kernel whose center has this polar cosine, -1 to 1.
double kernel_integral_above(Kernel kernel, double bandwidth, double cosine);

/// Integral of a lobe's kernel times the cosine over light directions above the horizon, viewed from unit `wv`. Times
/// the coefficient it is the lobe's part of the directional albedo. The relative error is 1e-3 for most lobes and 1e-2
/// where the horizon cuts off most of the lobe.
double reflected_light(const WarpedLobe& lobe, const Vec3d& wv);

}  // namespace velour
