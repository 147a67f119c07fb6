// Lines of many points.
#pragma once

#include <vector>

#include "sphere/vec.h"

namespace velour {

/// Some of `points`, the first and the last among them, whose line is nowhere further than `tolerance` from what is
/// left out [DP73].
std::vector<Vec2> simplified(const std::vector<Vec2>& points, float tolerance);

/// Pieces of the line, `on` long, with gaps of `off` between them.
std::vector<std::vector<Vec2>> dashed(const std::vector<Vec2>& points, float on, float off);

}  // namespace velour
