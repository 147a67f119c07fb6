// How fast a BTF is evaluated.
#pragma once

#include <functional>

#include "sphere/vec.h"

namespace velour {

/// f at a place of the tile, without a footprint.
using BtfValue = std::function<Rgb(const Vec2& place, const DirectionPair& pair)>;

/// Evaluations a second of one thread, each of a random place, view and light (by the cosine): the median of five runs.
double evaluation_rate(const BtfValue& value);

}  // namespace velour
