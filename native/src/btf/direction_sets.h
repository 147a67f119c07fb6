// Named sets of directions.
#pragma once

#include <string>
#include <vector>

#include "btf/polar_angles.h"

namespace velour {

/// "81": bonn_directions(); "105": capture_directions(); any other integer from 1 to kMaxDirections: even_directions(),
/// with directions within 0.11 degrees of the plane raised to that elevation. Throws Error(invalid_argument).
std::vector<PolarAngles> named_directions(const std::string& name);

}  // namespace velour
