// What a shader fetches, as a picture of four floats a pixel.
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

}  // namespace velour
