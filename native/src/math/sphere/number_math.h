// Scalar versions of the operations used by formulas that are written once for scalars and SIMD lanes
// (math/sphere/lanes-inl.h).
#pragma once

#include <algorithm>
#include <cmath>

namespace velour {

inline float square_root(float x) { return std::sqrt(x); }
inline float larger(float a, float b) { return std::max(a, b); }
inline float smaller(float a, float b) { return std::min(a, b); }
/// Both `yes` and `no` are evaluated.
inline float select(bool condition, float yes, float no) { return condition ? yes : no; }

}  // namespace velour
