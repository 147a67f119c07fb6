// Grids of texels: bilinear lookups, and the next mip level.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>
#include "math/sphere/vec.h"

namespace velour {

// Bilinear lookups on a periodic grid of texels.

struct BilinearTexels {
  std::array<uint32_t, 4> index;  // row by row
  std::array<float, 4> weight;    // sum 1
};

/// The two texels around a coordinate on a periodic axis of `size` texels, and the fraction between them.
struct LinearTexels {
  LinearTexels(float texel, uint32_t size) {
    const auto extent = static_cast<float>(size);
    // Rounding may push the coordinate past either end of the period.
    const float inside = std::max(texel - std::floor(texel * (1 / extent)) * extent, 0.0f);
    const float whole = std::floor(inside);
    part = inside - whole;
    const auto at = static_cast<uint32_t>(static_cast<int32_t>(whole));
    low = at < size ? at : 0;
    high = low + 1 < size ? low + 1 : 0;
  }
  uint32_t low, high;
  float part;
};

/// `width`: texels per row.
inline BilinearTexels bilinear_between(const LinearTexels& x, const LinearTexels& y, uint32_t width) {
  const uint32_t low = y.low * width, high = y.high * width;
  return {{low + x.low, low + x.high, high + x.low, high + x.high},
          {(1 - x.part) * (1 - y.part), x.part * (1 - y.part), (1 - x.part) * y.part, x.part * y.part}};
}

/// `texel`: in texels from the center of the first one; its magnitude must be below 2^24.
inline BilinearTexels bilinear_at(const Vec2& texel, uint32_t width, uint32_t height) {
  return bilinear_between({texel.x, width}, {texel.y, height}, width);
}

/// `place`: in tiles.
inline BilinearTexels bilinear_texels(const Vec2& place, uint32_t width, uint32_t height) {
  return bilinear_at(place * Vec2(width, height) - 0.5f, width, height);
}

// Downsampling by one mip level.

/// Extent of the next mip level: half, rounded down, at least 1.
inline uint32_t half_of(uint32_t extent) { return extent > 1 ? extent / 2 : 1; }

/// The mip level after `image` ([row][column][channel], `width` x `height`). Each texel is the mean over the area of
/// the finer level that it covers, for any sizes.
std::vector<float> half_image(std::span<const float> image, uint32_t width, uint32_t height, uint32_t channels);

}  // namespace velour
