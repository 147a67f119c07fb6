// Detects directions of a BTF that coincide although their angles differ.
#pragma once

#include <string>

#include "btf/pair_layout.h"

namespace velour {

/// Warning about views and lights that coincide with an earlier one (phi 0 and 360, any phi at theta 0); interpolation
/// uses the earlier one only. Empty if all differ.
std::string repeated_directions(const PairLayout& layout);

}  // namespace velour
