// Where on a pyramid of mip levels a ray's footprint is looked up.
#pragma once

#include "sphere/vec.h"

namespace velour {

/// Trilinear look-ups [Wil83] at the level of the footprint's width, several along its length [MPFJ99].
struct FootprintTaps {
  int count = 1;
  float level = 0;        // log2 of a tap's texels
  bool magnified = true;  // no longer than a texel: one look-up of the finest level
  Vec2 step{0.0f};        // from tap to tap, texture coordinates

  Vec2 place(const Vec2& uv, int tap) const {
    return uv + (static_cast<float>(tap) - 0.5f * static_cast<float>(count - 1)) * step;
  }
  static constexpr int kMost = 8;
};

/// `footprint`: the sides (columns) of a parallelogram in texture coordinates, of any size; `size`: texels along both.
/// A footprint of a stretch beyond FootprintTaps::kMost is taken as that much wider.
FootprintTaps footprint_taps(const Mat2& footprint, const Vec2& size);

}  // namespace velour
