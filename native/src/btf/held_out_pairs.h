// Pairs of directions that models are judged by and that no fit is given.
#pragma once

#include "btf/pair_layout.h"

namespace velour {

/// `count` pairs of a view and a light, view i with light i alone: each direction drawn uniformly by solid angle up to
/// 75 degrees from the normal, where the last ring of measured sets is. The same pairs whenever they are asked for;
/// fewer are the first of more. `two_sided`: every direction lies above or below the plane with equal chance. Throws
/// Error(invalid_argument) for none, and for more than kMaxDirections.
PairLayout held_out_pairs(uint32_t count, bool two_sided);

}  // namespace velour
