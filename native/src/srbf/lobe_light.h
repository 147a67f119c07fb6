// How much light a lobe is of.
#pragma once

#include "srbf/kernel.h"
#include "srbf/warped_lobe.h"

namespace velour {

/// The integral over the upper hemisphere of a kernel about a centre of this polar cosine, -1 to 1.
double kernel_integral_above(Kernel kernel, double bandwidth, double cosine);

/// The integral of a lobe's kernel times the cosine over light directions above the horizon, seen from unit `wv`:
/// times the coefficient, its part of the directional albedo. Relative error of 1e-3 for most lobes, of 1e-2 where the
/// horizon cuts most of them off.
double reflected_light(const WarpedLobe& lobe, const Vec3d& wv);

}  // namespace velour
