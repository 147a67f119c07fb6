// The inner loop of reliefs.
#pragma once

#include <cstdint>

#include "sphere/vec.h"

namespace velour {

/// A ray over a periodic height field, in texels from the centre of texel (0, 0): at `when` in [0, 1] it is over
/// from + when way, at height top - when fall.
struct ReliefMarch {
  const float* heights;  // [height + 1][width + 1]: the first row and column again behind the last ones
  uint32_t width, height;
  Vec2 from, way;
  float top, fall;
};

/// When the ray first is not above the surface, which is bilinear between texels: looked for in steps of a texel (of a
/// 1024th of the way where that is longer), then by chords within the step. 1 at the latest. Run-time dispatched SIMD.
float first_meeting(const ReliefMarch& march);

}  // namespace velour
