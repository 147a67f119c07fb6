// Texels of bytes, blended.
#pragma once

#include <cstdint>

#include "btf/bilinear_texels.h"

namespace velour {

inline constexpr uint32_t kByteRowPadding = 16;

/// Texels of a tile that repeats: [row][column][stride] bytes.
struct ByteTexels {
  const uint8_t* bytes;
  uint32_t width, height, stride;
};

/// to[i] += step[i] times the bilinear mean of bytes i at `texel` (bilinear_at), times `weight`, for i < stride, which
/// is a multiple of kByteRowPadding; `step` and `to` are aligned to 64 bytes. Run-time dispatched SIMD.
void add_bilinear_bytes(const ByteTexels& texels, const Vec2& texel, float weight, const float* step, float* to);

}  // namespace velour
