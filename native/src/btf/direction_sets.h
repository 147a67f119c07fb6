// Sets of directions by name.
#pragma once

#include <string>
#include <vector>

#include "btf/polar_angles.h"

namespace velour {

/// "81": bonn_directions(); "105": capture_directions(); another whole number from 1 to kMaxDirections:
/// even_directions(), of which those within 0.11 degrees of the plane are lifted to that. Throws
/// Error(invalid_argument).
std::vector<PolarAngles> named_directions(const std::string& name);

}  // namespace velour
