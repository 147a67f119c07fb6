// Held-out pairs of directions, which validate models and are never fitted.
#pragma once

#include "btf/measure/pair_layout.h"

namespace velour {

/// `count` pairs; view i is paired with light i only. Directions are sampled uniformly by solid angle up to 75 degrees
/// from the normal, the last ring of measured sets. Deterministic: a smaller set is a prefix of a larger one.
/// `two_sided`: each direction lies above or below the plane with equal probability. Throws Error(invalid_argument)
/// unless `count` is from 1 to kMaxDirections.
PairLayout held_out_pairs(uint32_t count, bool two_sided);

}  // namespace velour
