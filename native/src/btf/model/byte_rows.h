// Bilinear interpolation of byte texels.
#pragma once

#include <cstdint>

#include "image/bilinear_texels.h"

namespace velour {

inline constexpr uint32_t kByteRowPadding = 16;

/// Texels of a periodic tile: [row][column][stride] bytes.
struct ByteTexels {
  const uint8_t* bytes;
  uint32_t width, height, stride;
};

/// For i < stride: to[i] += weight * step[i] * (bilinear mean of byte i at `texel`, see bilinear_at). `stride` must be
/// a multiple of kByteRowPadding; `step` and `to` must be aligned to 64 bytes. Run-time dispatched SIMD.
void add_bilinear_bytes(const ByteTexels& texels, const Vec2& texel, float weight, const float* step, float* to);

}  // namespace velour
