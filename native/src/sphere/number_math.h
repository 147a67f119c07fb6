// The few operations of formulas that are written once, for one number and for several side by side (srbf/lanes-inl.h):
// here of one.
#pragma once

#include <algorithm>
#include <cmath>

namespace velour {

inline float square_root(float x) { return std::sqrt(x); }
inline float larger(float a, float b) { return std::max(a, b); }
inline float smaller(float a, float b) { return std::min(a, b); }
/// Both are computed.
inline float select(bool condition, float yes, float no) { return condition ? yes : no; }

}  // namespace velour
