#include "scene/mesh.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <unordered_map>
#include "base/parallel.h"

namespace velour {

namespace {

Vec3 unit(const Vec3d& v) { return Vec3(v / glm::length(v)); }

/// Whether a direction can be normalized in float32.
bool usable_normal(const Vec3& n) {
  const float length_sq = glm::dot(n, n);
  return length_sq > 1e-30f && std::isfinite(length_sq);
}

void in_pieces(size_t count, const auto& work) {
  const Progress unwatched;
  parallel_pieces((count + kTrianglesOfPiece - 1) / kTrianglesOfPiece, 0, unwatched, [&](size_t piece) {
    const size_t begin = piece * kTrianglesOfPiece;
    work(begin, std::min(begin + kTrianglesOfPiece, count));
  });
}

}  // namespace

Mesh::Mesh(const MeshArrays& arrays) {
  arrays.check();
  const std::vector<uint32_t> kept = usable_triangles(arrays);
  const size_t count = kept.size();
  dropped_ = static_cast<uint32_t>(arrays.triangles.size() - count);
  positions_.assign(arrays.positions.begin(), arrays.positions.end());
  // Unused vertices may hold anything, which the ray tracer must not see.
  for (Vec3& p : positions_) {
    if (!usable_position(p)) p = Vec3(0.0f);
  }
  triangles_.resize(count);
  normals_.resize(3 * count);
  if (!arrays.corner_uvs.empty()) {
    uvs_.resize(3 * count);
    more_uvs_.assign(arrays.more_uvs.size() / arrays.corner_uvs.size(), std::vector<Vec2>(3 * count));
    if (!arrays.relief_uvs.empty()) relief_uvs_.resize(3 * count);
  }
  if (!arrays.corner_colors.empty()) {
    colors_.assign(arrays.corner_colors.size() / arrays.corners(), std::vector<Rgb>(3 * count));
  }
  if (!arrays.material_slots.empty()) slots_.resize(count);
  in_pieces(count, [&](size_t begin, size_t end) { copy_triangles(arrays, kept, begin, end); });
  const bool given = !arrays.corner_normals.empty() || !arrays.vertex_normals.empty();
  const bool all_flat = !arrays.smooth.empty() && std::ranges::none_of(arrays.smooth, std::identity());
  const std::vector<Vec3d> sums = given || all_flat ? std::vector<Vec3d>() : summed_normals();
  in_pieces(count, [&](size_t begin, size_t end) { finish_normals(arrays, kept, sums, begin, end); });
  find_bounds();
}

void Mesh::find_bounds() {
  std::vector<Bounds> of_piece((triangles_.size() + kTrianglesOfPiece - 1) / kTrianglesOfPiece);
  in_pieces(triangles_.size(), [&](size_t begin, size_t end) {
    Bounds bounds;
    for (size_t i = begin; i < end; ++i) {
      for (int k = 0; k < 3; ++k) bounds.add(positions_[triangles_[i][k]]);
    }
    of_piece[begin / kTrianglesOfPiece] = bounds;
  });
  bounds_ = {};
  for (const Bounds& bounds : of_piece) bounds_.add(bounds);
}

void Mesh::copy_triangles(const MeshArrays& arrays, std::span<const uint32_t> kept, size_t begin, size_t end) {
  for (size_t i = begin; i < end; ++i) {
    const size_t from = kept[i];
    glm::uvec3 t = arrays.triangles[from];
    if (!arrays.corner_vertices.empty()) {
      for (int k = 0; k < 3; ++k) t[k] = arrays.corner_vertices[t[k]];
    }
    triangles_[i] = t;
    if (!slots_.empty()) slots_[i] = arrays.material_slots[from];
    for (int k = 0; k < 3; ++k) normals_[3 * i + static_cast<size_t>(k)] = arrays.normal(from, k, t[k]);
    if (!uvs_.empty()) copy_uvs(arrays, from, i);
    copy_colors(arrays, from, i);
  }
}

void Mesh::copy_uvs(const MeshArrays& arrays, size_t from, size_t to) {
  for (int k = 0; k < 3; ++k) {
    const size_t corner = arrays.corner(from, k), place = 3 * to + static_cast<size_t>(k);
    uvs_[place] = arrays.corner_uvs[corner];
    for (size_t set = 0; set < more_uvs_.size(); ++set) {
      more_uvs_[set][place] = arrays.more_uvs[set * arrays.corner_uvs.size() + corner];
    }
    if (!relief_uvs_.empty()) relief_uvs_[place] = arrays.relief_uvs[corner];
  }
}

void Mesh::copy_colors(const MeshArrays& arrays, size_t from, size_t to) {
  for (size_t set = 0; set < colors_.size(); ++set) {
    for (int k = 0; k < 3; ++k) {
      const Rgb color = arrays.corner_colors[set * arrays.corners() + arrays.corner(from, k)];
      const bool finite = std::isfinite(color.r + color.g + color.b);
      colors_[set][3 * to + static_cast<size_t>(k)] = finite ? color : Rgb(0.0f);
    }
  }
}

std::vector<Vec3d> Mesh::summed_normals() const {
  std::vector<Vec3d> sums(positions_.size(), Vec3d(0.0));
  for (const glm::uvec3& t : triangles_) {
    const Vec3d n = area_normal(positions_[t.x], positions_[t.y], positions_[t.z]);
    for (int k = 0; k < 3; ++k) sums[t[k]] += n;
  }
  return sums;
}

void Mesh::finish_normals(const MeshArrays& arrays, std::span<const uint32_t> kept, std::span<const Vec3d> sums,
                          size_t begin, size_t end) {
  for (size_t i = begin; i < end; ++i) {
    const glm::uvec3& t = triangles_[i];
    const bool summed = !sums.empty() && arrays.is_smooth(kept[i]);
    for (int k = 0; k < 3; ++k) {
      Vec3& n = normals_[3 * i + static_cast<size_t>(k)];
      if (summed && glm::length(sums[t[k]]) > 0.0) n = unit(sums[t[k]]);
      n = usable_normal(n) ? glm::normalize(n) : unit(area_normal(positions_[t.x], positions_[t.y], positions_[t.z]));
    }
  }
}

namespace {

template <typename T>
T interpolate(const T& a, const T& b, const T& c, const Vec2& uv) {
  return (1.0f - uv.x - uv.y) * a + uv.x * b + uv.y * c;
}

}  // namespace

Vec3 Mesh::position(uint32_t triangle, const Vec2& uv) const {
  const glm::uvec3& t = triangles_[triangle];
  return interpolate(positions_[t.x], positions_[t.y], positions_[t.z], uv);
}

Vec3 Mesh::position_magnitude(uint32_t triangle, const Vec2& uv) const {
  const glm::uvec3& t = triangles_[triangle];
  return interpolate(glm::abs(positions_[t.x]), glm::abs(positions_[t.y]), glm::abs(positions_[t.z]), uv);
}

Vec3 Mesh::shading_normal(uint32_t triangle, const Vec2& uv) const {
  const Vec3* n = &normals_[3 * static_cast<size_t>(triangle)];
  const Vec3 mean = interpolate(n[0], n[1], n[2], uv);
  return usable_normal(mean) ? mean : n[0];  // opposed corner normals cancel
}

Rgb Mesh::color(uint32_t triangle, const Vec2& uv, size_t set) const {
  const size_t corner = 3 * static_cast<size_t>(triangle);
  if (set >= colors_.size() || corner >= colors_[set].size()) return Rgb(0.0f);
  const Rgb* c = &colors_[set][corner];
  return interpolate(c[0], c[1], c[2], uv);
}

Vec3 Mesh::tangent(uint32_t triangle, const Mat2& map) const {
  if (uvs_.empty()) return Vec3(0.0f);
  const glm::uvec3& t = triangles_[triangle];
  const Vec2* uv = &uvs_[3 * static_cast<size_t>(triangle)];
  const Vec3 e1 = positions_[t.y] - positions_[t.x], e2 = positions_[t.z] - positions_[t.x];
  const Vec2 d1 = map * (uv[1] - uv[0]), d2 = map * (uv[2] - uv[0]);
  const float determinant = d1.x * d2.y - d1.y * d2.x;
  const Vec3 along = (d2.y * e1 - d1.y * e2) * (determinant < 0.0f ? -1.0f : 1.0f);
  return determinant != 0.0f && usable_normal(along) ? along : Vec3(0.0f);
}

void Mesh::make_tangents() {
  if (uvs_.empty() || has_tangents()) return;
  tangents_ = corner_tangents(positions_, triangles_, normals_, relief_uvs_.empty() ? uvs_ : relief_uvs_);
  relief_uvs_ = {};
}

Mat3 Mesh::relief(uint32_t triangle, const Vec2& uv) const {
  const CornerTangent* t = &tangents_[3 * static_cast<size_t>(triangle)];
  const Vec3 normal = shading_normal(triangle, uv);
  const Vec3 tangent = interpolate(t[0].direction, t[1].direction, t[2].direction, uv);
  return {tangent, t[0].side * glm::cross(normal, tangent), normal};
}

Vec3 Mesh::smooth_tangent(uint32_t triangle, const Vec2& uv, const Mat2& map) const {
  const Mat3 space = relief(triangle, uv);
  const Vec3 normal = glm::normalize(space[2]);
  const Vec3 x = space[0] - glm::dot(space[0], normal) * normal;
  const Vec3 y = tangents_[3 * static_cast<size_t>(triangle)].side * glm::cross(normal, x);
  // First column of the inverse of `map`, up to a positive factor.
  return (glm::determinant(map) < 0.0f ? -1.0f : 1.0f) * (map[1].y * x - map[0].y * y);
}

uint64_t Mesh::bytes() const {
  uint64_t more = 0;
  for (const std::vector<Vec2>& set : more_uvs_) more += set.size() * sizeof(Vec2);
  for (const std::vector<Rgb>& set : colors_) more += set.size() * sizeof(Rgb);
  return positions_.size() * sizeof(Vec3) + triangles_.size() * sizeof(glm::uvec3) + normals_.size() * sizeof(Vec3) +
         (uvs_.size() + relief_uvs_.size()) * sizeof(Vec2) + slots_.size() * sizeof(uint32_t) +
         tangents_.size() * sizeof(CornerTangent) + sides_.size() * sizeof(BorderEdge) + more;
}

Mesh Mesh::lifted(std::span<const ShellHeights> heights, const Mat3& metric) const {
  Mesh mesh = *this;
  const auto count = static_cast<uint32_t>(positions_.size());
  std::vector<bool> chosen(triangles_.size());
  std::vector<Vec3> up(count, Vec3(0.0f));
  std::vector<ShellHeights> of_vertex(count);
  for (size_t i = 0; i < triangles_.size(); ++i) {
    const uint32_t slot = material_slot(static_cast<uint32_t>(i));
    const ShellHeights h = heights.empty() ? ShellHeights{} : heights[std::min<size_t>(slot, heights.size() - 1)];
    chosen[i] = h.top > h.bottom;
    if (!chosen[i]) continue;
    mesh.triangles_[i] += count;
    for (int k = 0; k < 3; ++k) {
      up[triangles_[i][k]] += normals_[3 * i + static_cast<size_t>(k)];
      of_vertex[triangles_[i][k]] = h;
    }
  }
  const Mat3 inverse = glm::inverse(metric);
  mesh.positions_.insert(mesh.positions_.end(), positions_.begin(), positions_.end());
  for (uint32_t v = 0; v < count; ++v) {
    // Normals transform by the inverse transpose, so the world-space normal, brought back to object space, is `inverse`
    // times the object's.
    const Vec3 back = inverse * up[v];
    const float square = glm::dot(up[v], back);
    up[v] = square > 0 ? back / std::sqrt(square) : Vec3(0.0f);
    mesh.positions_[count + v] += up[v] * of_vertex[v].top;
  }
  std::unordered_map<uint32_t, uint32_t> lower;  // bottom vertex by the top vertex above it
  const auto below = [&](uint32_t v) {
    const auto [found, is_new] = lower.emplace(v, static_cast<uint32_t>(mesh.positions_.size()));
    if (is_new) mesh.positions_.push_back(positions_[v - count] + up[v - count] * of_vertex[v - count].bottom);
    return found->second;
  };
  for (const BorderEdge& e : border_edges(positions_, triangles_, chosen)) {
    const glm::uvec3& top = mesh.triangles_[e.triangle];
    const uint32_t a = top[static_cast<int>(e.corner)], b = top[static_cast<int>((e.corner + 1) % 3)];
    mesh.add_side(e, {glm::uvec3(below(a), below(b), b), glm::uvec3(below(a), b, a)});
  }
  mesh.find_bounds();
  return mesh;
}

void Mesh::add_side(const BorderEdge& edge, const std::array<glm::uvec3, 2>& quad) {
  const size_t first = 3 * size_t{edge.triangle}, a = first + edge.corner, b = first + (edge.corner + 1) % 3;
  const auto repeat = [](auto& values, std::initializer_list<size_t> corners) {
    for (const size_t corner : corners) {
      const auto value = values[corner];
      values.push_back(value);
    }
  };
  triangles_.insert(triangles_.end(), quad.begin(), quad.end());
  repeat(normals_, {a, b, b, a, b, a});
  if (!uvs_.empty()) repeat(uvs_, {a, b, b, a, b, a});
  if (!tangents_.empty()) repeat(tangents_, {a, b, b, a, b, a});
  if (!slots_.empty()) repeat(slots_, {edge.triangle, edge.triangle});
  sides_.push_back(edge);
}

Mesh::SidePoint Mesh::on_side(uint32_t triangle, const Vec2& uv) const {
  const uint32_t number = triangle - first_side();
  const BorderEdge& edge = sides_[number / 2];
  const bool lower = number % 2 == 0;  // the triangle with two corners at the bottom
  const float along = std::min(1.0f, lower ? uv.x + uv.y : uv.x), height = lower ? uv.y : uv.x + uv.y;
  float weight[3] = {0, 0, 0};
  weight[edge.corner] = 1 - along;
  weight[(edge.corner + 1) % 3] = along;
  return {edge.triangle, {weight[1], weight[2]}, std::min(1.0f, height)};
}

}  // namespace velour
