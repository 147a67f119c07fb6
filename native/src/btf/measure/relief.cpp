#include "btf/measure/relief.h"

#include <algorithm>
#include <cmath>

namespace velour {
namespace {

// In texels, by experiment: a weave of height 18 is traced faster without the lids, gravel of height 43 with them.
constexpr float kHigh = 32;
constexpr float kLowest = 1e-4f;  // minimum z of a view; smaller values are clamped

std::vector<float> parts(const std::vector<float>& heights, float bottom, float top) {
  std::vector<float> out;
  const float scale = top > bottom ? 1 / (top - bottom) : 0.0f;
  for (const float h : heights) out.push_back((h - bottom) * scale);
  return out;
}

}  // namespace

Relief::Relief(uint32_t width, uint32_t height, const std::vector<float>& heights, float aspect)
    : width_(width),
      rows_(height),
      heights_(heights),
      aspect_(aspect),
      bottom_(*std::min_element(heights.begin(), heights.end())),
      top_(*std::max_element(heights.begin(), heights.end())),
      words_(width, height, parts(heights, bottom_, top_)) {}

Vec2 Relief::seen_texel(const Vec2& place, const Vec3& wv) const {
  const Vec2 size(words_.columns.extent, words_.rows.extent);
  const Vec2 shift = size * Vec2(wv.x, wv.y / aspect_) * (1 / std::max(wv.z, kLowest));  // per unit of height
  const Vec2 on_plane = place * size - 0.5f;
  if (flat()) return on_plane + bottom_ * shift;
  const bool high = (top_ - bottom_) * size.x > kHigh;
  return first_meeting(words_, {on_plane + top_ * shift, (bottom_ - top_) * shift, high});
}

Vec2 Relief::seen(const Vec2& place, const Vec3& wv) const {
  return (seen_texel(place, wv) + 0.5f) * Vec2(words_.columns.inverse, words_.rows.inverse);
}

Vec2 Relief::slope(uint32_t x, uint32_t y) const {
  const float dx = height_of((x + 1) % width(), y) - height_of((x + width() - 1) % width(), y);
  const float dy = height_of(x, (y + 1) % height()) - height_of(x, (y + height() - 1) % height());
  const Vec2 slope(-dx * static_cast<float>(width()) / 2, -dy * static_cast<float>(height()) / (2 * aspect_));
  const float steepness = glm::length(slope);
  return steepness > kSteepest ? slope * (kSteepest / steepness) : slope;
}

Vec2 Relief::slope(const BilinearTexels& texels) const {
  Vec2 sum(0.0f);
  for (size_t i = 0; i < 4; ++i) {
    sum += texels.weight[i] * slope(texels.index[i] % width(), texels.index[i] / width());
  }
  return sum;
}

}  // namespace velour
