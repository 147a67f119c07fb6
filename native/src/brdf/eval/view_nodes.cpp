#include "brdf/eval/view_nodes.h"

#include <algorithm>
#include <cmath>

namespace velour {

namespace {

/// Interval of a coordinate in [0, cells], and the position in it.
struct Interval {
  int low;
  float share;
  Interval(float x, int cells)
      : low(std::clamp(static_cast<int>(x), 0, cells - 1)),
        share(std::clamp(x - static_cast<float>(low), 0.0f, 1.0f)) {}
  int nearest() const { return low + (share > 0.5f); }
};

/// Inverse of Lambert's map.
Vec3 view_of(Vec2 p) {
  const float length = glm::length(p);
  if (length >= 1) return {p.x / length, p.y / length, 0};
  const float scale = std::sqrt(2 - length * length);
  return {scale * p.x, scale * p.y, 1 - length * length};
}

}  // namespace

Vec3 ViewNodes::view(int node) const {
  const auto size = static_cast<float>(cells_);
  if (isotropic_) return view_of({static_cast<float>(node) / size, 0});
  const int x = node % (cells_ + 1), y = node / (cells_ + 1);
  return view_of({2 * static_cast<float>(x) / size - 1, 2 * static_cast<float>(y) / size - 1});
}

NodeWeights ViewNodes::at(const ViewPlace& place) const {
  const auto size = static_cast<float>(cells_);
  if (isotropic_) {
    const Interval r(size * place.radius, cells_);
    return {2, {r.low, r.low + 1}, {1 - r.share, r.share}, r.nearest()};
  }
  const Interval x(0.5f * size * (1 + place.radius * place.cos_phi), cells_);
  const Interval y(0.5f * size * (1 + place.radius * place.sin_phi), cells_);
  const int side = cells_ + 1, first = y.low * side + x.low;
  return {4,
          {first, first + 1, first + side, first + side + 1},
          {(1 - y.share) * (1 - x.share), (1 - y.share) * x.share, y.share * (1 - x.share), y.share * x.share},
          y.nearest() * side + x.nearest()};
}

}  // namespace velour
