#include "scene/polygon_triangles.h"

#include <algorithm>
#include <cmath>

namespace velour {
namespace {

/// Twice the area times the unit normal. Relative to the first corner, to stay exact far from the origin.
Vec3d newell_normal(std::span<const Vec3> corners) {
  Vec3d sum(0);
  const Vec3d origin(corners[0]);
  for (size_t i = 1; i + 1 < corners.size(); ++i)
    sum += glm::cross(Vec3d(corners[i]) - origin, Vec3d(corners[i + 1]) - origin);
  return sum;
}

}  // namespace

std::span<const glm::uvec3> PolygonTriangles::cut(std::span<const Vec3> corners) {
  triangles_.clear();
  if (corners.size() == 3) {
    triangles_.push_back({0, 1, 2});
    return triangles_;
  }
  project(corners);
  if (corners.size() == 4)
    cut_quad();
  else
    clip_ears();
  return triangles_;
}

/// Projects along the axis that is closest to the normal; swaps the other two if the polygon would become clockwise.
void PolygonTriangles::project(std::span<const Vec3> corners) {
  const Vec3d normal = newell_normal(corners), size = glm::abs(normal);
  const int dropped = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
  int u = (dropped + 1) % 3, v = (dropped + 2) % 3;
  if (normal[dropped] < 0) std::swap(u, v);
  points_.clear();
  for (const Vec3& corner : corners) {
    const Vec3d from_first = Vec3d(corner) - Vec3d(corners[0]);
    points_.push_back({from_first[u], from_first[v]});
  }
}

/// Positive if a, b, c turn left.
double PolygonTriangles::turn(uint32_t a, uint32_t b, uint32_t c) const {
  const glm::dvec2 ab = points_[b] - points_[a], ac = points_[c] - points_[a];
  return ab.x * ac.y - ab.y * ac.x;
}

/// Cuts along the diagonal that leaves both triangles inside; along corners 0 and 2 if the quad is convex.
void PolygonTriangles::cut_quad() {
  const double first = std::min(turn(0, 1, 2), turn(0, 2, 3)), second = std::min(turn(1, 2, 3), turn(1, 3, 0));
  if (first > 0 || first >= second) {
    triangles_.push_back({0, 1, 2});
    triangles_.push_back({0, 2, 3});
  } else {
    triangles_.push_back({1, 2, 3});
    triangles_.push_back({1, 3, 0});
  }
}

/// Whether `corner` turns left and no other corner lies in its triangle. Only corners that do not turn left can.
bool PolygonTriangles::is_ear(uint32_t corner) const {
  const uint32_t a = previous_[corner], c = next_[corner];
  if (turn(a, corner, c) <= 0) return false;
  for (uint32_t other = next_[c]; other != a; other = next_[other]) {
    if (points_[other] == points_[a] || points_[other] == points_[corner] || points_[other] == points_[c]) continue;
    if (turn(previous_[other], other, next_[other]) > 0) continue;
    if (turn(a, corner, other) >= 0 && turn(corner, c, other) >= 0 && turn(c, a, other) >= 0) return false;
  }
  return true;
}

void PolygonTriangles::clip_ears() {
  const auto count = static_cast<uint32_t>(points_.size());
  next_.resize(count);
  previous_.resize(count);
  for (uint32_t i = 0; i < count; ++i) {
    next_[i] = (i + 1) % count;
    previous_[i] = (i + count - 1) % count;
  }
  uint32_t corner = 0;
  for (uint32_t left = count, tried = 0; left > 2;) {
    // A polygon that intersects itself or is degenerate may have no ear; then any corner is cut off.
    if (!is_ear(corner) && tried < left) {
      corner = next_[corner];
      ++tried;
      continue;
    }
    const uint32_t a = previous_[corner], c = next_[corner];
    triangles_.push_back({a, corner, c});
    next_[a] = c;
    previous_[c] = a;
    --left;
    tried = 0;
    corner = next_[c];  // skips a corner, which avoids fans of slivers
  }
}

}  // namespace velour
