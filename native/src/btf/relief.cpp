#include "btf/relief.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace velour {
namespace {

/// `i` of a period `size`, for any i.
int wrapped(int i, uint32_t size) {
  const int n = static_cast<int>(size), rest = i % n;
  return rest < 0 ? rest + n : rest;
}

/// Grid lines along one coordinate that a ray crosses, in the order that it does.
struct Crossings {
  float next;  // when: in [0, 1] of the way from the highest to the lowest point
  float step;  // between two of them
  int line;    // the next one
  int sign;

  Crossings(float from, float way) : sign(way < 0 ? -1 : 1) {
    line = static_cast<int>(sign > 0 ? std::floor(from) + 1 : std::ceil(from) - 1);
    step = way != 0 ? 1 / std::abs(way) : std::numeric_limits<float>::infinity();
    next = way != 0 ? (static_cast<float>(line) - from) / way : step;
  }
  void cross() {
    line += sign;
    next += step;
  }
};

}  // namespace

Relief::Relief(uint32_t width, uint32_t height, std::vector<float> heights, float aspect)
    : width_(width), rows_(height), heights_(std::move(heights)), aspect_(aspect) {
  const auto [low, high] = std::minmax_element(heights_.begin(), heights_.end());
  bottom_ = *low;
  top_ = *high;
}

float Relief::bilinear(const Vec2& texel) const {
  const Vec2 low = glm::floor(texel), part = texel - low;
  const int x0 = wrapped(static_cast<int>(low.x), width_), y0 = wrapped(static_cast<int>(low.y), rows_);
  const int x1 = wrapped(x0 + 1, width_), y1 = wrapped(y0 + 1, rows_);
  return std::lerp(std::lerp(at(x0, y0), at(x1, y0), part.x), std::lerp(at(x0, y1), at(x1, y1), part.x), part.y);
}

Vec2 Relief::seen(const Vec2& place, const Vec3& wv) const {
  const Vec2 size(width_, rows_);
  const Vec2 shift = Vec2(wv.x, wv.y / aspect_) / wv.z;  // in tiles, a unit of height
  if (flat()) return place + bottom_ * shift;
  // In texels, from the highest point of the relief down to its lowest.
  const Vec2 from = (place + top_ * shift) * size - 0.5f, way = (bottom_ - top_) * shift * size;
  const float fall = top_ - bottom_;
  const auto end = [&](float when) { return (from + when * way + 0.5f) / size; };
  float before = 0, gap_before = top_ - bilinear(from);
  if (gap_before <= 0) return end(0);
  Crossings x(from.x, way.x), y(from.y, way.y);
  for (;;) {
    const bool across_x = x.next < y.next;
    const float when = std::min(x.next, y.next);
    if (!(when < 1)) break;
    float surface;
    if (across_x) {
      const float along = from.y + when * way.y, low = std::floor(along);
      const int column = wrapped(x.line, width_), row = wrapped(static_cast<int>(low), rows_);
      surface = std::lerp(at(column, row), at(column, wrapped(row + 1, rows_)), along - low);
      x.cross();
    } else {
      const float along = from.x + when * way.x, low = std::floor(along);
      const int row = wrapped(y.line, rows_), column = wrapped(static_cast<int>(low), width_);
      surface = std::lerp(at(column, row), at(wrapped(column + 1, width_), row), along - low);
      y.cross();
    }
    const float gap = top_ - when * fall - surface;
    if (gap <= 0) return end(std::lerp(before, when, gap_before / (gap_before - gap)));
    before = when;
    gap_before = gap;
  }
  const float gap = bottom_ - bilinear(from + way);  // not positive: nothing lies lower
  return end(std::lerp(before, 1.0f, gap_before / (gap_before - gap)));
}

Vec2 Relief::slope(uint32_t x, uint32_t y) const {
  const int column = static_cast<int>(x), row = static_cast<int>(y);
  const float dx = at(wrapped(column + 1, width_), row) - at(wrapped(column - 1, width_), row);
  const float dy = at(column, wrapped(row + 1, rows_)) - at(column, wrapped(row - 1, rows_));
  const Vec2 slope(-dx * static_cast<float>(width_) / 2, -dy * static_cast<float>(rows_) / (2 * aspect_));
  const float steepness = glm::length(slope);
  return steepness > kSteepest ? slope * (kSteepest / steepness) : slope;
}

}  // namespace velour
