// The relief of a captured BTF.
#pragma once

#include <vector>

#include "btf/btf_measurement.h"
#include "btf/relief.h"
#include "compress/side_views.h"

namespace velour {

/// The relief of every level, finest first, with heights rounded to half floats: first hits of the view nearest to the
/// normal, averaged over texels; the lowest point of the shell where it hits nothing. Flat, on the reference plane, for
/// a BTF without structure.
std::vector<Relief> relief_pyramid(const BtfMeasurement& measurement, const SideDirections& side);
/// The reference plane, with the same levels.
std::vector<Relief> plane_pyramid(const TexelGrid& grid);

std::vector<HalfBits> stored_heights(const Relief& relief);

}  // namespace velour
