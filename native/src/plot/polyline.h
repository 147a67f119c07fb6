// Simplification and dashing of polylines.
#pragma once

#include <vector>

#include "sphere/vec.h"

namespace velour {

/// A subset of `points`, including the first and the last, whose line is within `tolerance` of all omitted points
/// [DP73].
std::vector<Vec2> simplified(const std::vector<Vec2>& points, float tolerance);

/// Pieces of the line, `on` long, with gaps of `off` between them.
std::vector<std::vector<Vec2>> dashed(const std::vector<Vec2>& points, float on, float off);

}  // namespace velour
