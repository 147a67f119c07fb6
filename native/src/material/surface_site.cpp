#include "material/surface_site.h"

#include <algorithm>
#include <cmath>

namespace velour {
namespace {

/// Length and width of a parallelogram: the singular values of the matrix of its sides.
struct Extent {
  Vec2 along;  // major axis, of length `length`
  float length, width;
};

Extent extent_of(const Mat2& sides) {
  const Vec2 &a = sides[0], &b = sides[1];
  const float xx = a.x * a.x + b.x * b.x, yy = a.y * a.y + b.y * b.y, xy = a.x * a.y + b.x * b.y;
  const float root = std::sqrt(0.25f * (xx - yy) * (xx - yy) + xy * xy);
  const float length_sq = 0.5f * (xx + yy) + root;
  if (!(length_sq > 0.0f)) return {Vec2(0.0f), 0.0f, 0.0f};
  const float length = std::sqrt(length_sq);
  // The eigenvector has two forms; this one does not cancel.
  const Vec2 along = xx >= yy ? Vec2(length_sq - yy, xy) : Vec2(xy, length_sq - xx);
  const float size = glm::length(along);
  return {size > 0.0f ? along * (length / size) : Vec2(length, 0.0f), length, std::abs(a.x * b.y - a.y * b.x) / length};
}

}  // namespace

FootprintTaps footprint_taps(const Mat2& footprint, const Vec2& size) {
  const Extent extent = extent_of({footprint[0] * size, footprint[1] * size});  // in texels
  FootprintTaps taps;
  if (!(extent.length > 1.0f)) return taps;
  taps.magnified = false;
  const float tap = std::max({extent.width, extent.length / FootprintTaps::kMost, 1.0f});
  taps.level = std::log2(tap);
  taps.count = std::clamp(static_cast<int>(std::ceil(extent.length / tap - 0.01f)), 1, FootprintTaps::kMost);
  taps.step = extent.along / size / static_cast<float>(taps.count);
  return taps;
}

}  // namespace velour
