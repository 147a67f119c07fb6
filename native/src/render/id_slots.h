// How much of a pixel each of the ids in it covers.
#pragma once

#include <span>

namespace velour {

/// Floats that a pixel needs for its `ranks` heaviest ids: a few ids more than are shown, because what has come early
/// need not be heavy in the end.
constexpr int floats_of_ids(int ranks) { return 2 * (ranks + 2); }

/// Adds `weight` to that of `id` in `slots`, pairs of both; 0 is no id. Where there is no place, the id is left out.
void add_id(float id, float weight, std::span<float> slots);

/// The ids of `slots` in places `first` and `first` + 1 when they are sorted by weight, the heaviest first (of equal
/// weights: the smaller id), each with its weight times `scale`; 0 where there are no more.
void write_ids(std::span<const float> slots, int first, float scale, float out[4]);

}  // namespace velour
