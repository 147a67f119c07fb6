// A table for shaders: an image with four floats per pixel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace velour {

struct TablePixels {
  uint32_t width = 0, height = 0;
  std::vector<float> rgba;  // [row][column][4]

  TablePixels() = default;
  TablePixels(uint32_t w, uint32_t h) : width(w), height(h), rgba(size_t{4} * w * h) {}
  float* at(uint32_t x, uint32_t y) { return rgba.data() + 4 * (size_t{y} * width + x); }
  const float* at(uint32_t x, uint32_t y) const { return rgba.data() + 4 * (size_t{y} * width + x); }
};

/// Width in pixels of the border around a repeating table, which holds its opposite side.
inline constexpr uint32_t kTableBorder = 1;
/// The texel at pixel `pixel` of a bordered row of `size` texels.
inline uint32_t wrapped_texel(uint32_t pixel, uint32_t size) { return (pixel + size - kTableBorder) % size; }

}  // namespace velour
