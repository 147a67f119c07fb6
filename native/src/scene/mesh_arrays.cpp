#include "scene/mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <unordered_map>
#include "base/error.h"
#include "base/parallel.h"
#include "math/sphere/frame.h"
#include "math/sphere/random.h"
#include "scene/motion.h"

namespace velour {

namespace {

/// Embree's own bound on coordinates, beyond which triangles vanish silently.
constexpr float kReach = 1.8e18f;

void check_length(size_t found, size_t expected, const char* what) {
  if (found == 0 || found == expected) return;
  refuse("A mesh has " + std::to_string(found) + " " + what + ", but its triangles require " +
         std::to_string(expected) + ".");
}

/// `more`: number of coordinates in all further sets; `first`: in the first set.
void check_more_uvs(size_t more, size_t first) {
  if (more == 0 || (first > 0 && more % first == 0)) return;
  refuse("A mesh has " + std::to_string(more) +
         " texture coordinates in further UV sets; the number must be a multiple of the " + std::to_string(first) +
         " in its first UV set.");
}

/// Error message if a triangle names a missing corner or vertex.
std::optional<std::string> missing(const MeshArrays& arrays, size_t triangle) {
  const auto lacks = [&](const char* what, size_t number, size_t count, const char* plural) {
    return "Triangle " + std::to_string(triangle) + " has " + what + " index " + std::to_string(number) +
           ", but the mesh has only " + std::to_string(count) + " " + plural + ".";
  };
  for (int k = 0; k < 3; ++k) {
    uint32_t vertex = arrays.triangles[triangle][k];
    if (!arrays.corner_vertices.empty()) {
      if (vertex >= arrays.corner_vertices.size())
        return lacks("corner", vertex, arrays.corner_vertices.size(), "corners");
      vertex = arrays.corner_vertices[vertex];
    }
    if (vertex >= arrays.positions.size()) return lacks("vertex", vertex, arrays.positions.size(), "vertices");
  }
  return std::nullopt;
}

bool usable(const MeshArrays& arrays, size_t triangle) {
  const glm::uvec3& t = arrays.triangles[triangle];
  const auto vertex = [&](int k) { return arrays.corner_vertices.empty() ? t[k] : arrays.corner_vertices[t[k]]; };
  const auto stays_usable = [&](uint32_t v) {
    for (size_t i = v; i < arrays.moved_positions.size(); i += arrays.positions.size()) {
      if (!usable_position(arrays.moved_positions[i])) return false;
    }
    return usable_position(arrays.positions[v]);
  };
  const uint32_t v[3] = {vertex(0), vertex(1), vertex(2)};
  return std::ranges::all_of(v, stays_usable) &&
         glm::length(area_normal(arrays.positions[v[0]], arrays.positions[v[1]], arrays.positions[v[2]])) > 0.0;
}

}  // namespace

bool usable_position(const Vec3& p) {
  return std::abs(p.x) < kReach && std::abs(p.y) < kReach && std::abs(p.z) < kReach;  // false for NaN
}

Vec3d area_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  return glm::cross(Vec3d(b) - Vec3d(a), Vec3d(c) - Vec3d(a));
}

void MeshArrays::check() const {
  const size_t n = triangles.size(), corners = this->corners();
  check_length(corner_normals.size(), corners, "corner normals");
  check_length(corner_uvs.size(), corners, "corner texture coordinates");
  check_more_uvs(more_uvs.size(), corner_uvs.size());
  check_length(relief_uvs.size(), corners, "texture coordinates of normal maps");
  if (corners == 0 ? !corner_colors.empty() : corner_colors.size() % corners != 0) {
    refuse("A mesh has " + std::to_string(corner_colors.size()) +
           " corner colors; the number must be a multiple of its " + std::to_string(corners) + " corners.");
  }
  check_length(material_slots.size(), n, "material slots");
  check_length(smooth.size(), n, "smooth flags");
  check_length(vertex_normals.size(), positions.size(), "vertex normals");
  if (steps == 1 || steps > kMaxMotionSteps) {
    refuse("A mesh deforms in " + std::to_string(steps) + " steps; the number must be 0 or 2 to " +
           std::to_string(kMaxMotionSteps) + ".");
  }
  if (moved_positions.size() != steps * positions.size()) {
    refuse("A mesh that deforms in " + std::to_string(steps) + " steps has " + std::to_string(moved_positions.size()) +
           " moved positions, but " + std::to_string(positions.size()) + " vertices.");
  }
  check_length(moved_corner_normals.size(), steps * corner_normals.size(), "moved corner normals");
  check_length(moved_vertex_normals.size(), steps * vertex_normals.size(), "moved vertex normals");
}

MeshArrays MeshArrays::at(size_t step) const {
  MeshArrays arrays = *this;
  const auto part = [step](std::span<const Vec3> all, std::span<const Vec3>& of) {
    of = all.empty() ? all : all.subspan(step * of.size(), of.size());
  };
  part(moved_positions, arrays.positions);
  part(moved_corner_normals, arrays.corner_normals);
  part(moved_vertex_normals, arrays.vertex_normals);
  return arrays;
}

Vec3 MeshArrays::normal(size_t triangle, int k, uint32_t vertex) const {
  if (!corner_normals.empty()) return corner_normals[corner(triangle, k)];
  return vertex_normals.empty() || !is_smooth(triangle) ? Vec3(0.0f) : vertex_normals[vertex];
}

std::vector<uint32_t> usable_triangles(const MeshArrays& arrays) {
  const size_t n = arrays.triangles.size(), pieces = (n + kTrianglesOfPiece - 1) / kTrianglesOfPiece;
  std::vector<std::vector<uint32_t>> kept(pieces);
  std::vector<std::optional<std::string>> wrong(pieces);
  const Progress unwatched;
  parallel_pieces(pieces, 0, unwatched, [&](size_t piece) {
    const size_t begin = piece * kTrianglesOfPiece, end = std::min(begin + kTrianglesOfPiece, n);
    kept[piece].reserve(end - begin);
    for (size_t i = begin; i < end && !wrong[piece]; ++i) {
      wrong[piece] = missing(arrays, i);
      if (!wrong[piece] && usable(arrays, i)) kept[piece].push_back(static_cast<uint32_t>(i));
    }
  });
  for (const auto& sentence : wrong) {
    if (sentence) refuse(*sentence);
  }
  if (pieces == 1) return std::move(kept[0]);
  std::vector<uint32_t> all;
  all.reserve(n);
  for (const std::vector<uint32_t>& piece : kept) all.insert(all.end(), piece.begin(), piece.end());
  return all;
}

namespace {

Vec3 across(const Vec3& v, const Vec3& normal) { return v - glm::dot(v, normal) * normal; }

Vec3 unit_or_zero(const Vec3& v) {
  const float length = glm::length(v);
  return length > 0 && std::isfinite(length) ? v / length : Vec3(0.0f);
}

/// Position, normal and texture coordinate of a corner; corners are merged if all of them are equal.
using Place = std::array<float, 8>;

/// [corners] Group of each corner, counted from 0; equal places have the same group.
std::vector<uint32_t> welded(const std::vector<Place>& place) {
  std::vector<uint32_t> order(place.size()), number(place.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](uint32_t a, uint32_t b) { return place[a] != place[b] ? place[a] < place[b] : a < b; });
  uint32_t count = 0;
  for (size_t i = 0; i < order.size(); ++i) {
    if (i > 0 && place[order[i]] != place[order[i - 1]]) ++count;
    number[order[i]] = count;
  }
  return number;
}

class TangentSums {
 public:
  TangentSums(std::span<const Vec3> positions, std::span<const glm::uvec3> triangles, std::span<const Vec3> normals,
              std::span<const Vec2> uvs)
      : positions_(positions), triangles_(triangles), normals_(normals), uvs_(uvs) {
    std::vector<Place> place(normals.size());
    for (size_t c = 0; c < place.size(); ++c) {
      const Vec3 p = position(c), n = normals[c];
      const Vec2 t = uv(c);
      place[c] = {p.x, p.y, p.z, n.x, n.y, n.z, t.x, t.y};
      for (float& x : place[c]) x += 0.0f;  // -0 is 0
    }
    group_ = welded(place);
    sum_.resize(2 * (group_.empty() ? 0 : 1 + static_cast<size_t>(*std::ranges::max_element(group_))), Vec3(0.0f));
    for (size_t t = 0; t < triangles.size(); ++t) add(t);
  }

  CornerTangent at(size_t corner) const {
    const float own = side(corner / 3);
    for (const float s : {own != 0 ? own : 1.0f, own != 0 ? -own : -1.0f}) {
      const Vec3 direction = unit_or_zero(sum_[slot(corner, s)]);
      if (direction != Vec3(0.0f)) return {direction, own != 0 ? own : s};
    }
    return {Frame::about(normals_[corner]).x, 1.0f};
  }

 private:
  Vec3 position(size_t corner) const {
    return positions_[triangles_[corner / 3][static_cast<glm::length_t>(corner % 3)]];
  }
  Vec2 uv(size_t corner) const {
    const Vec2 t = uvs_[corner];
    return std::isfinite(t.x + t.y) ? t : Vec2(0.0f);
  }
  size_t slot(size_t corner, float side) const { return 2 * static_cast<size_t>(group_[corner]) + (side < 0 ? 1 : 0); }

  /// CornerTangent::side of a triangle; 0 if it has no area in texture space.
  float side(size_t triangle) const {
    const Vec2 a = uv(3 * triangle + 1) - uv(3 * triangle), b = uv(3 * triangle + 2) - uv(3 * triangle);
    const float area = a.x * b.y - a.y * b.x;
    return area > 0 ? 1.0f : (area < 0 ? -1.0f : 0.0f);
  }

  void add(size_t triangle) {
    const float s = side(triangle);
    if (s == 0) return;
    const size_t first = 3 * triangle;
    const Vec2 a = uv(first + 1) - uv(first), b = uv(first + 2) - uv(first);
    const Vec3 along =
        s * (b.y * (position(first + 1) - position(first)) - a.y * (position(first + 2) - position(first)));
    for (size_t k = 0; k < 3; ++k) {
      const size_t corner = first + k;
      const Vec3& normal = normals_[corner];
      const auto edge = [&](size_t step) {
        return unit_or_zero(across(position(first + (k + step) % 3) - position(corner), normal));
      };
      const float angle = std::acos(std::clamp(glm::dot(edge(1), edge(2)), -1.0f, 1.0f));
      sum_[slot(corner, s)] += angle * unit_or_zero(across(along, normal));
    }
  }

  std::span<const Vec3> positions_;
  std::span<const glm::uvec3> triangles_;
  std::span<const Vec3> normals_;
  std::span<const Vec2> uvs_;
  std::vector<uint32_t> group_;  // of each corner
  std::vector<Vec3> sum_;        // two per group: of triangles with side 1 and with side -1
};

}  // namespace

std::vector<CornerTangent> corner_tangents(std::span<const Vec3> positions, std::span<const glm::uvec3> triangles,
                                           std::span<const Vec3> corner_normals, std::span<const Vec2> corner_uvs) {
  const TangentSums sums(positions, triangles, corner_normals, corner_uvs);
  std::vector<CornerTangent> tangents(corner_normals.size());
  for (size_t c = 0; c < tangents.size(); ++c) tangents[c] = sums.at(c);
  return tangents;
}

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
