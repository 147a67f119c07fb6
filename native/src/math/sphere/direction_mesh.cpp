#include "math/sphere/direction_mesh.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace velour {
namespace {

using Vec2d = glm::dvec2;

/// Projects the hemisphere onto the unit disk, from the pole -z. Directions below the horizon are moved to it.
Vec2d stereographic(const Vec3& direction) {
  const Vec3d d(direction);
  if (d.z < 0) {
    const double s = std::max(std::hypot(d.x, d.y), 1e-30);
    return {d.x / s, d.y / s};
  }
  return Vec2d(d.x, d.y) / (1.0 + d.z);
}

/// Twice the area of the triangle, positive when counter-clockwise.
double area(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Whether `p` lies in the circle through the corners of a counter-clockwise triangle. Ties (rings put four directions
/// on one circle) count as outside, with a margin well above rounding errors.
bool in_circle(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& p) {
  const Vec2d u = a - p, v = b - p, w = c - p;
  const double uu = glm::dot(u, u), vv = glm::dot(v, v), ww = glm::dot(w, w);
  const double det = u.x * (v.y * ww - vv * w.y) - u.y * (v.x * ww - vv * w.x) + uu * (v.x * w.y - v.y * w.x);
  return det > 1e-12 * std::max({uu, vv, ww});
}

}  // namespace

DirectionMesh::DirectionMesh(std::span<const Vec3> directions) {
  for (const Vec3& d : directions) points_.push_back(stereographic(d));
  triangulate();
  find_outline();
  fill_grid();
}

/// Bowyer-Watson: inserts one point at a time and replaces the triangles whose circumcircle contains it by a fan.
void DirectionMesh::triangulate() {
  const auto n = static_cast<uint32_t>(points_.size());
  points_.insert(points_.end(), {{-1e4, -1e4}, {1e4, -1e4}, {0, 1e4}});  // a triangle that encloses all points
  triangles_ = {{n, n + 1, n + 2}};
  for (uint32_t p = 0; p < n; ++p) {
    std::map<std::array<uint32_t, 2>, bool> edges;  // of removed triangles; inner ones occur both ways
    std::erase_if(triangles_, [&](const Triangle& t) {
      if (!in_circle(points_[t[0]], points_[t[1]], points_[t[2]], points_[p])) return false;
      for (size_t k = 0; k < 3; ++k) edges[{t[k], t[(k + 1) % 3]}] = true;
      return true;
    });
    for (const auto& [edge, there] : edges) {
      const bool inner = edges.contains({edge[1], edge[0]});
      if (!inner && area(points_[edge[0]], points_[edge[1]], points_[p]) > 0)
        triangles_.push_back({edge[0], edge[1], p});
    }
  }
  std::erase_if(triangles_, [&](const Triangle& t) { return std::max({t[0], t[1], t[2]}) >= n; });
  points_.resize(n);
  // The enclosing triangle is finite, so slivers along the outline may be missing; on_outline covers these gaps.
  std::sort(triangles_.begin(), triangles_.end());
}

void DirectionMesh::find_outline() {
  std::map<std::array<uint32_t, 2>, int> count;
  for (const Triangle& t : triangles_) {
    for (size_t k = 0; k < 3; ++k) ++count[{std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])}];
  }
  for (const auto& [edge, times] : count) {
    if (times == 1) outline_.push_back(edge);
  }
  if (!triangles_.empty()) return;
  // Collinear points, or fewer than three: the outline is the sorted line through them.
  std::vector<uint32_t> order(points_.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    return std::pair(points_[a].x, points_[a].y) < std::pair(points_[b].x, points_[b].y);
  });
  for (size_t i = 0; i + 1 < order.size(); ++i) outline_.push_back({order[i], order[i + 1]});
  if (order.size() == 1) outline_.push_back({0, 0});
}

void DirectionMesh::fill_grid() {
  for (const Triangle& t : triangles_) {
    corners_.push_back({{points_[t[0]], points_[t[1]], points_[t[2]]}, t});
    corners_.back().whole = area(points_[t[0]], points_[t[1]], points_[t[2]]);
  }
  std::vector<std::vector<uint32_t>> cells(size_t{kGrid} * kGrid);
  for (uint32_t i = 0; i < corners_.size(); ++i) {
    const auto& p = corners_[i].point;
    const Vec2d low = glm::min(p[0], glm::min(p[1], p[2])), high = glm::max(p[0], glm::max(p[1], p[2]));
    for (int y = cell_of(low.y); y <= cell_of(high.y); ++y) {
      for (int x = cell_of(low.x); x <= cell_of(high.x); ++x) cells[static_cast<size_t>(y * kGrid + x)].push_back(i);
    }
  }
  for (size_t i = 0; i < cells.size(); ++i) {
    const Vec2d middle = (Vec2d(i % kGrid, i / kGrid) + 0.5) * (2.0 / kGrid) - 1.0;
    std::array<double, 3> weight;
    // Test the triangle that contains the center of the cell first: it usually covers most of the cell.
    std::stable_partition(cells[i].begin(), cells[i].end(),
                          [&](uint32_t t) { return inside(corners_[t], middle, weight); });
    first_.push_back(static_cast<uint32_t>(meeting_.size()));
    meeting_.insert(meeting_.end(), cells[i].begin(), cells[i].end());
  }
  first_.push_back(static_cast<uint32_t>(meeting_.size()));
}

int DirectionMesh::cell_of(double x) { return std::clamp(static_cast<int>((x + 1) * 0.5 * kGrid), 0, kGrid - 1); }

bool DirectionMesh::inside(const Corners& t, const Vec2d& p, std::array<double, 3>& weight) {
  const auto& [a, b, c] = t.point;
  weight = {area(b, c, p), area(c, a, p), area(a, b, p)};
  return std::min({weight[0], weight[1], weight[2]}) >= -1e-9 * t.whole;
}

DirectionMesh::Weights DirectionMesh::on_outline(const Vec2d& p) const {
  Weights best;
  double least = 1e30;
  for (const auto& [a, b] : outline_) {
    const Vec2d along = points_[b] - points_[a];
    const double length_sq = glm::dot(along, along);
    const double t = length_sq > 0 ? std::clamp(glm::dot(p - points_[a], along) / length_sq, 0.0, 1.0) : 0.0;
    const double distance = glm::distance(p, points_[a] + t * along);
    if (distance >= least) continue;
    least = distance;
    best = {{a, b, a}, {static_cast<float>(1 - t), static_cast<float>(t), 0.0f}};
  }
  return best;
}

DirectionMesh::Weights DirectionMesh::at(const Vec3& direction) const {
  const Vec2d p = stereographic(direction);
  const auto cell = static_cast<size_t>(cell_of(p.y) * kGrid + cell_of(p.x));
  std::array<double, 3> w;
  for (uint32_t i = first_[cell]; i < first_[cell + 1]; ++i) {
    const Corners& corners = corners_[meeting_[i]];
    if (!inside(corners, p, w)) continue;
    for (double& x : w) x = std::max(x, 0.0);
    const double scale = 1 / (w[0] + w[1] + w[2]);
    return {corners.index,
            {static_cast<float>(w[0] * scale), static_cast<float>(w[1] * scale), static_cast<float>(w[2] * scale)}};
  }
  return on_outline(p);
}

}  // namespace velour
