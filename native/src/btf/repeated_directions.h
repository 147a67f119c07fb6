// Directions of a BTF that have other angles and are the same.
#pragma once

#include <string>

#include "btf/pair_layout.h"

namespace velour {

/// A sentence on views and lights whose direction an earlier one has (phi 0 and 360, any phi at theta 0), which is the
/// only one that interpolation meets; empty where all differ.
std::string repeated_directions(const PairLayout& layout);

}  // namespace velour
