#include "scene/border_edges.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "sphere/random.h"

namespace velour {
namespace {

constexpr double kOnePlace = 1e-6;  // welding distance, relative to the extent

struct Edge {
  uint64_t ends;  // both vertices, the smaller one in the high 32 bits
  BorderEdge edge;
};

uint64_t ends_of(uint32_t a, uint32_t b) { return (uint64_t{std::min(a, b)} << 32) + std::max(a, b); }

/// Edges that share their pair of end vertices with no other edge, in triangle order.
std::vector<Edge> unshared(std::vector<Edge> edges) {
  const auto place = [](const Edge& e) { return 3 * uint64_t{e.edge.triangle} + e.edge.corner; };
  std::ranges::sort(
      edges, [&](const Edge& a, const Edge& b) { return a.ends != b.ends ? a.ends < b.ends : place(a) < place(b); });
  std::vector<Edge> single;
  for (size_t i = 0, end; i < edges.size(); i = end) {
    for (end = i + 1; end < edges.size() && edges[end].ends == edges[i].ends;) ++end;
    if (end == i + 1) single.push_back(edges[i]);
  }
  std::ranges::sort(single, {}, place);
  return single;
}

/// Gives points within a distance of each other the same number, that of the first.
class Welder {
 public:
  explicit Welder(double distance) : distance_(std::max(distance, 1e-300)) {}

  uint32_t number(uint32_t vertex, const Vec3& p) {
    const Vec3d at(p);
    const auto cell = [&](double x) { return static_cast<int64_t>(std::floor(x / (2 * distance_))); };
    const int64_t x = cell(at.x), y = cell(at.y), z = cell(at.z);
    for (int i = 0; i < 27; ++i) {
      const auto found = cells_.find(key(x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1));
      if (found == cells_.end()) continue;
      for (const Point& other : found->second) {
        if (glm::length(other.place - at) <= distance_) return other.number;
      }
    }
    cells_[key(x, y, z)].push_back({at, vertex});
    return vertex;
  }

 private:
  struct Point {
    Vec3d place;
    uint32_t number;
  };
  static uint64_t key(int64_t x, int64_t y, int64_t z) {
    return mix64(mix64(mix64(static_cast<uint64_t>(x)) + static_cast<uint64_t>(y)) + static_cast<uint64_t>(z));
  }

  double distance_;
  std::unordered_map<uint64_t, std::vector<Point>> cells_;
};

double extent_of(std::span<const Vec3> positions, const std::vector<Edge>& edges) {
  double extent = 0;
  for (const Edge& e : edges) {
    for (const uint64_t v : {e.ends >> 32, e.ends & 0xffffffffu}) {
      for (int i = 0; i < 3; ++i) extent = std::max(extent, std::abs(static_cast<double>(positions[v][i])));
    }
  }
  return extent;
}

}  // namespace

std::vector<BorderEdge> border_edges(std::span<const Vec3> positions, std::span<const glm::uvec3> triangles,
                                     const std::vector<bool>& chosen) {
  std::vector<Edge> edges;
  for (uint32_t t = 0; t < triangles.size(); ++t) {
    for (uint32_t k = 0; k < 3 && chosen[t]; ++k) {
      const auto corner = [&](uint32_t i) { return triangles[t][static_cast<int>(i % 3)]; };
      edges.push_back({ends_of(corner(k), corner(k + 1)), {t, k}});
    }
  }
  edges = unshared(std::move(edges));
  Welder welder(kOnePlace * extent_of(positions, edges));
  std::unordered_map<uint32_t, uint32_t> welded;
  const auto number = [&](uint64_t vertex) {
    const auto v = static_cast<uint32_t>(vertex);
    const auto found = welded.find(v);
    return found != welded.end() ? found->second : welded[v] = welder.number(v, positions[v]);
  };
  for (Edge& e : edges) e.ends = ends_of(number(e.ends >> 32), number(e.ends & 0xffffffffu));
  std::erase_if(edges, [](const Edge& e) { return e.ends >> 32 == (e.ends & 0xffffffffu); });
  std::vector<BorderEdge> border;
  for (const Edge& e : unshared(std::move(edges))) border.push_back(e.edge);
  return border;
}

}  // namespace velour
