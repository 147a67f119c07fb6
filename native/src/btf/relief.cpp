#include "btf/relief.h"

#include <algorithm>
#include <cmath>

#include "btf/relief_march.h"

namespace velour {
Relief::Relief(uint32_t width, uint32_t height, const std::vector<float>& heights, float aspect)
    : width_(width), rows_(height), aspect_(aspect) {
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  bottom_ = *low;
  top_ = *high;
  padded_.reserve(size_t{width + 1} * (height + 1));
  for (uint32_t y = 0; y <= height; ++y) {
    for (uint32_t x = 0; x <= width; ++x) padded_.push_back(heights[size_t{y % height} * width + x % width]);
  }
}

Vec2 Relief::seen(const Vec2& place, const Vec3& wv) const {
  const Vec2 size(width_, rows_);
  const Vec2 shift = Vec2(wv.x, wv.y / aspect_) / wv.z;  // in tiles, a unit of height
  if (flat()) return place + bottom_ * shift;
  const Vec2 from = (place + top_ * shift) * size - 0.5f, way = (bottom_ - top_) * shift * size;
  const float when = first_meeting({padded_.data(), width_, rows_, from, way, top_, top_ - bottom_});
  return (from + when * way + 0.5f) / size;
}

std::vector<float> Relief::heights() const {
  std::vector<float> heights;
  for (uint32_t y = 0; y < rows_; ++y) {
    for (uint32_t x = 0; x < width_; ++x) heights.push_back(height_of(x, y));
  }
  return heights;
}

Vec2 Relief::slope(uint32_t x, uint32_t y) const {
  const float dx = height_of((x + 1) % width_, y) - height_of((x + width_ - 1) % width_, y);
  const float dy = height_of(x, (y + 1) % rows_) - height_of(x, (y + rows_ - 1) % rows_);
  const Vec2 slope(-dx * static_cast<float>(width_) / 2, -dy * static_cast<float>(rows_) / (2 * aspect_));
  const float steepness = glm::length(slope);
  return steepness > kSteepest ? slope * (kSteepest / steepness) : slope;
}

Vec2 Relief::slope(const BilinearTexels& texels) const {
  Vec2 sum(0.0f);
  for (size_t i = 0; i < 4; ++i) {
    sum += texels.weight[i] * slope(texels.index[i] % width_, texels.index[i] / width_);
  }
  return sum;
}

}  // namespace velour
