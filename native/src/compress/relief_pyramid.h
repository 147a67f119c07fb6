// The relief that a capture found.
#pragma once

#include <vector>

#include "btf/btf_measurement.h"
#include "btf/relief.h"
#include "compress/side_views.h"

namespace velour {

/// Of every level, the finest first, with heights as half floats hold them: first hits of the view nearest to the
/// normal, averaged over texels. Where it meets nothing, the lowest point of the shell. Flat, on the reference plane,
/// for a BTF without structure.
std::vector<Relief> relief_pyramid(const BtfMeasurement& measurement, const SideDirections& side);
/// The reference plane, as large.
std::vector<Relief> plane_pyramid(const TexelGrid& grid);

std::vector<HalfBits> stored_heights(const Relief& relief);

}  // namespace velour
