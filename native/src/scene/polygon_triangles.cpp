#include <algorithm>
#include <cmath>
#include "scene/mesh_file.h"

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
  if (corners.size() == 4) {
    cut_quad();
  } else if (std::ranges::all_of(points_,
                                 [](const glm::dvec2& p) { return std::isfinite(p.x) && std::isfinite(p.y); })) {
    clip_ears();
  } else {  // no corner would be an ear
    for (uint32_t i = 1; i + 1 < corners.size(); ++i) triangles_.push_back({0, i, i + 1});
  }
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

/// Positive if a, b, c turn left; exactly 0 if two of them coincide.
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

/// Whether the path from c over `corner` to a turns back on itself, as at the tip of an edge traversed in both
/// directions.
bool PolygonTriangles::is_spike(uint32_t corner) const {
  const uint32_t a = previous_[corner], c = next_[corner];
  return turn(a, corner, c) == 0 && glm::dot(points_[a] - points_[corner], points_[c] - points_[corner]) >= 0;
}

/// How often the outline that is left winds around `point`.
int PolygonTriangles::winding(const glm::dvec2& point, uint32_t start) const {
  int turns = 0;
  uint32_t corner = start;
  do {
    const glm::dvec2 from = points_[corner] - point, to = points_[next_[corner]] - point;
    const double side = from.x * to.y - from.y * to.x;
    if (from.y <= 0 && to.y > 0 && side > 0) ++turns;
    if (from.y > 0 && to.y <= 0 && side < 0) --turns;
    corner = next_[corner];
  } while (corner != start);
  return turns;
}

/// Whether the triangle of `corner` and its neighbors can be cut off: no part of the outline lies within it. Corners on
/// its border do not block it unless the outline enters from there. Zero-width parts of the outline may lie along the
/// border; the winding number then tells inside from outside.
bool PolygonTriangles::is_ear(uint32_t corner) {
  if (is_spike(corner)) return true;
  const uint32_t a = previous_[corner], b = corner, c = next_[corner];
  if (turn(a, b, c) <= 0) return false;
  const auto is_at = [&](uint32_t v, uint32_t end) { return points_[v] == points_[end]; };
  bool touches = false;
  for (uint32_t v = next_[c]; v != a; v = next_[v]) {
    ++examined_;
    const double ab = turn(a, b, v), bc = turn(b, c, v), ca = turn(c, a, v);
    if (ab < 0 || bc < 0 || ca < 0) continue;
    if (ca == 0 && !is_at(v, c) && !is_at(v, a)) return false;  // the diagonal would pass through this corner
    const auto enters = [&](uint32_t to) {
      return (ab > 0 || turn(a, b, to) > 0) && (bc > 0 || turn(b, c, to) > 0) && (ca > 0 || turn(c, a, to) > 0);
    };
    if (enters(previous_[v]) || enters(next_[v])) return false;
    touches = true;
  }
  return !touches || winding((points_[a] + points_[b] + points_[c]) / 3.0, corner) > 0;
}

/// The remaining corner whose triangle has the smallest area.
uint32_t PolygonTriangles::flattest(uint32_t start) const {
  uint32_t best = start;
  const auto area = [&](uint32_t corner) { return std::abs(turn(previous_[corner], corner, next_[corner])); };
  for (uint32_t corner = next_[start]; corner != start; corner = next_[corner]) {
    if (area(corner) < area(best)) best = corner;
  }
  return best;
}

void PolygonTriangles::clip_ears() {
  const auto count = static_cast<uint32_t>(points_.size());
  next_.resize(count);
  previous_.resize(count);
  for (uint32_t i = 0; i < count; ++i) {
    next_[i] = (i + 1) % count;
    previous_[i] = (i + count - 1) % count;
  }
  // Where an outline passes through the same corners many times, the search for ears would grow with its cube. Others
  // examine each corner about once for each ear.
  const uint64_t most = 4 * static_cast<uint64_t>(count) * count + 1'000'000;
  examined_ = 0;
  uint32_t corner = 0;
  for (uint32_t remaining = count, tried = 0; remaining > 2;) {
    const bool searches = tried < remaining && examined_ < most;
    if (searches && !is_ear(corner)) {
      corner = next_[corner];
      ++tried;
      continue;
    }
    // A polygon that is degenerate or intersects itself may have no ear.
    if (!searches) corner = flattest(corner);
    const uint32_t a = previous_[corner], c = next_[corner];
    triangles_.push_back({a, corner, c});
    next_[a] = c;
    previous_[c] = a;
    --remaining;
    tried = 0;
    corner = next_[c];  // skips a corner, which avoids fans of slivers
  }
}

}  // namespace velour
