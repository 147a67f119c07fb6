// Mip level and positions of the texture look-ups for a ray footprint.
#pragma once

#include "sphere/vec.h"

namespace velour {

/// Trilinear look-ups [Wil83] at the level of the footprint's width, several along its length [MPFJ99].
struct FootprintTaps {
  int count = 1;
  float level = 0;        // log2 of a tap's width in texels
  bool magnified = true;  // the footprint is no longer than a texel: one look-up on the finest level
  Vec2 step{0.0f};        // between taps, in texture coordinates

  Vec2 place(const Vec2& uv, int tap) const {
    return uv + (static_cast<float>(tap) - 0.5f * static_cast<float>(count - 1)) * step;
  }
  static constexpr int kMost = 8;
};

/// `footprint`: sides (columns) of a parallelogram in texture coordinates, of any size; `size`: texels along both axes.
/// A footprint whose aspect ratio exceeds FootprintTaps::kMost is widened to that ratio.
FootprintTaps footprint_taps(const Mat2& footprint, const Vec2& size);

}  // namespace velour
