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
  finish_normals(arrays, kept, positions_, normals_);
  if (arrays.steps > 0) copy_shapes(arrays, kept);
  find_bounds();
}

void Mesh::copy_shapes(const MeshArrays& arrays, std::span<const uint32_t> kept) {
  steps_ = arrays.steps;
  moved_positions_.assign(arrays.moved_positions.begin(), arrays.moved_positions.end());
  for (Vec3& p : moved_positions_) {
    if (!usable_position(p)) p = Vec3(0.0f);
  }
  flat_.assign(triangles_.size(), true);
  const auto keep_flat = [&](std::span<const Vec3> positions, std::span<const Vec3> normals) {
    constexpr double kMinCosine = 1 - 1e-6;
    for (size_t i = 0; i < flat_.size(); ++i) {
      const glm::uvec3& t = triangles_[i];
      const Vec3d own = area_normal(positions[t.x], positions[t.y], positions[t.z]);
      const double least = kMinCosine * glm::length(own);
      for (size_t k = 0; k < 3; ++k) flat_[i] = flat_[i] && glm::dot(own, Vec3d(normals[3 * i + k])) >= least;
    }
  };
  keep_flat(positions_, normals_);
  moved_normals_.resize(steps_ * normals_.size());
  for (size_t step = 0; step < steps_; ++step) {
    const MeshArrays shape = arrays.at(step);
    const std::span<Vec3> normals = std::span(moved_normals_).subspan(step * normals_.size(), normals_.size());
    in_pieces(kept.size(), [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        for (int k = 0; k < 3; ++k)
          normals[3 * i + static_cast<size_t>(k)] = shape.normal(kept[i], k, triangles_[i][k]);
      }
    });
    const auto positions = std::span(moved_positions_).subspan(step * positions_.size(), positions_.size());
    finish_normals(shape, kept, positions, normals);
    keep_flat(positions, normals);
  }
}

void Mesh::find_bounds() {
  std::vector<Bounds> of_piece((triangles_.size() + kTrianglesOfPiece - 1) / kTrianglesOfPiece);
  in_pieces(triangles_.size(), [&](size_t begin, size_t end) {
    Bounds bounds;
    for (size_t i = begin; i < end; ++i) {
      for (int k = 0; k < 3; ++k) {
        const uint32_t v = triangles_[i][k];
        bounds.add(positions_[v]);
        for (size_t moved = v; moved < moved_positions_.size(); moved += positions_.size())
          bounds.add(moved_positions_[moved]);
      }
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

std::vector<Vec3d> Mesh::summed_normals(std::span<const Vec3> positions) const {
  std::vector<Vec3d> sums(positions.size(), Vec3d(0.0));
  for (const glm::uvec3& t : triangles_) {
    const Vec3d n = area_normal(positions[t.x], positions[t.y], positions[t.z]);
    for (int k = 0; k < 3; ++k) sums[t[k]] += n;
  }
  return sums;
}

void Mesh::finish_normals(const MeshArrays& arrays, std::span<const uint32_t> kept, std::span<const Vec3> positions,
                          std::span<Vec3> normals) const {
  const bool given = !arrays.corner_normals.empty() || !arrays.vertex_normals.empty();
  const bool all_flat = !arrays.smooth.empty() && std::ranges::none_of(arrays.smooth, std::identity());
  const std::vector<Vec3d> sums = given || all_flat ? std::vector<Vec3d>() : summed_normals(positions);
  in_pieces(kept.size(), [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const glm::uvec3& t = triangles_[i];
      const bool summed = !sums.empty() && arrays.is_smooth(kept[i]);
      for (int k = 0; k < 3; ++k) {
        Vec3& n = normals[3 * i + static_cast<size_t>(k)];
        if (summed && glm::length(sums[t[k]]) > 0.0) n = unit(sums[t[k]]);
        if (usable_normal(n)) {
          n = glm::normalize(n);
        } else {
          const Vec3d flat = area_normal(positions[t.x], positions[t.y], positions[t.z]);
          // Only the middle of a motion is known to have an area.
          n = glm::length(flat) > 0.0 ? unit(flat) : normals_[3 * i + static_cast<size_t>(k)];
        }
      }
    }
  });
}

namespace {

template <typename T>
T interpolate(const T& a, const T& b, const T& c, const Vec2& uv) {
  return (1.0f - uv.x - uv.y) * a + uv.x * b + uv.y * c;
}

}  // namespace

std::array<Vec3, 3> Mesh::corners(uint32_t triangle, float time) const {
  const glm::uvec3& t = triangles_[triangle];
  if (steps_ == 0) return {positions_[t.x], positions_[t.y], positions_[t.z]};
  const MotionTime at(steps_, time);
  const Vec3* const one = &moved_positions_[at.before * positions_.size()];
  const Vec3* const other = one + positions_.size();
  return {at.between(one[t.x], other[t.x]), at.between(one[t.y], other[t.y]), at.between(one[t.z], other[t.z])};
}

Vec3 Mesh::position(uint32_t triangle, const Vec2& uv, float time) const {
  const std::array<Vec3, 3> p = corners(triangle, time);
  return interpolate(p[0], p[1], p[2], uv);
}

Vec3 Mesh::position_magnitude(uint32_t triangle, const Vec2& uv, float time) const {
  const std::array<Vec3, 3> p = corners(triangle, time);
  return interpolate(glm::abs(p[0]), glm::abs(p[1]), glm::abs(p[2]), uv);
}

std::array<Vec3, 3> Mesh::corner_normals(uint32_t triangle, float time) const {
  const size_t first = 3 * static_cast<size_t>(triangle);
  if (steps_ == 0) return {normals_[first], normals_[first + 1], normals_[first + 2]};
  const MotionTime at(steps_, time);
  const Vec3* const one = &moved_normals_[at.before * normals_.size() + first];
  const Vec3* const other = one + normals_.size();
  std::array<Vec3, 3> n;
  if (triangle < flat_.size() && flat_[triangle]) {  // it turns as its corners move, not evenly
    const std::array<Vec3, 3> p = corners(triangle, time);
    const Vec3d flat = area_normal(p[0], p[1], p[2]);
    if (glm::length(flat) > 0.0) {
      n.fill(unit(flat));
      return n;
    }
  }
  for (size_t k = 0; k < 3; ++k) {
    const Vec3 mean = at.between(one[k], other[k]);
    n[k] = usable_normal(mean) ? glm::normalize(mean) : one[k];
  }
  return n;
}

Vec3 Mesh::shading_normal(uint32_t triangle, const Vec2& uv, float time) const {
  const std::array<Vec3, 3> n = corner_normals(triangle, time);
  const Vec3 mean = interpolate(n[0], n[1], n[2], uv);
  return usable_normal(mean) ? mean : n[0];  // opposed corner normals cancel
}

Rgb Mesh::color(uint32_t triangle, const Vec2& uv, size_t set) const {
  const size_t corner = 3 * static_cast<size_t>(triangle);
  if (set >= colors_.size() || corner >= colors_[set].size()) return Rgb(0.0f);
  const Rgb* c = &colors_[set][corner];
  return interpolate(c[0], c[1], c[2], uv);
}

Vec3 Mesh::tangent(uint32_t triangle, const Mat2& map, float time) const {
  if (uvs_.empty()) return Vec3(0.0f);
  const std::array<Vec3, 3> p = corners(triangle, time);
  const Vec2* uv = &uvs_[3 * static_cast<size_t>(triangle)];
  const Vec3 e1 = p[1] - p[0], e2 = p[2] - p[0];
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

Mat3 Mesh::relief(uint32_t triangle, const Vec2& uv, float time) const {
  const CornerTangent* t = &tangents_[3 * static_cast<size_t>(triangle)];
  const Vec3 normal = shading_normal(triangle, uv, time);
  const Vec3 tangent = interpolate(t[0].direction, t[1].direction, t[2].direction, uv);
  return {tangent, t[0].side * glm::cross(normal, tangent), normal};
}

Vec3 Mesh::smooth_tangent(uint32_t triangle, const Vec2& uv, const Mat2& map, float time) const {
  const Mat3 space = relief(triangle, uv, time);
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
  const size_t vectors = positions_.size() + normals_.size() + moved_positions_.size() + moved_normals_.size();
  return vectors * sizeof(Vec3) + triangles_.size() * sizeof(glm::uvec3) +
         (uvs_.size() + relief_uvs_.size()) * sizeof(Vec2) + slots_.size() * sizeof(uint32_t) +
         tangents_.size() * sizeof(CornerTangent) + sides_.size() * sizeof(BorderEdge) + more;
}

namespace {

/// Corners of the top whose data the corners of the two triangles of a side have.
std::array<size_t, 6> corners_of_side(const BorderEdge& edge) {
  const size_t first = 3 * size_t{edge.triangle}, a = first + edge.corner, b = first + (edge.corner + 1) % 3;
  return {a, b, b, a, b, a};
}

}  // namespace

Mesh Mesh::lifted(std::span<const ShellHeights> heights, const Mat3& metric) const {
  Mesh mesh = *this;
  const auto count = static_cast<uint32_t>(positions_.size());
  std::vector<bool> chosen(triangles_.size());
  std::vector<ShellHeights> of_vertex(count);
  for (size_t i = 0; i < triangles_.size(); ++i) {
    const uint32_t slot = material_slot(static_cast<uint32_t>(i));
    const ShellHeights h = heights.empty() ? ShellHeights{} : heights[std::min<size_t>(slot, heights.size() - 1)];
    chosen[i] = h.top > h.bottom;
    if (!chosen[i]) continue;
    mesh.triangles_[i] += count;
    for (int k = 0; k < 3; ++k) of_vertex[triangles_[i][k]] = h;
  }
  std::vector<uint32_t> bottoms;                 // vertices, in the order in which they follow the tops
  std::unordered_map<uint32_t, uint32_t> lower;  // bottom vertex by the top vertex above it
  const auto below = [&](uint32_t v) {
    const auto [found, is_new] = lower.emplace(v, 2 * count + static_cast<uint32_t>(bottoms.size()));
    if (is_new) bottoms.push_back(v - count);
    return found->second;
  };
  for (const BorderEdge& e : border_edges(positions_, triangles_, chosen)) {
    const glm::uvec3& top = mesh.triangles_[e.triangle];
    const uint32_t a = top[static_cast<int>(e.corner)], b = top[static_cast<int>((e.corner + 1) % 3)];
    mesh.add_side(e, {glm::uvec3(below(a), below(b), b), glm::uvec3(below(a), b, a)});
  }
  const Mat3 inverse = glm::inverse(metric);
  const auto add_raised = [&](std::span<const Vec3> positions, std::span<const Vec3> normals, std::vector<Vec3>& to) {
    std::vector<Vec3> up(count, Vec3(0.0f));
    for (size_t i = 0; i < chosen.size(); ++i) {
      for (int k = 0; k < 3 && chosen[i]; ++k) up[triangles_[i][k]] += normals[3 * i + static_cast<size_t>(k)];
    }
    to.insert(to.end(), positions.begin(), positions.end());
    for (uint32_t v = 0; v < count; ++v) {
      // Normals transform by the inverse transpose, so the world-space normal, brought back to object space, is
      // `inverse` times the object's.
      const Vec3 back = inverse * up[v];
      const float square = glm::dot(up[v], back);
      up[v] = square > 0 ? back / std::sqrt(square) : Vec3(0.0f);
      to.push_back(positions[v] + up[v] * of_vertex[v].top);
    }
    for (const uint32_t v : bottoms) to.push_back(positions[v] + up[v] * of_vertex[v].bottom);
  };
  mesh.positions_.clear();
  add_raised(positions_, normals_, mesh.positions_);
  mesh.moved_positions_.clear();
  mesh.moved_normals_.clear();
  mesh.flat_.clear();  // the shell follows the normals
  for (size_t step = 0; step < steps_; ++step) {
    const auto normals = std::span(moved_normals_).subspan(step * normals_.size(), normals_.size());
    add_raised(std::span(moved_positions_).subspan(step * count, count), normals, mesh.moved_positions_);
    mesh.moved_normals_.insert(mesh.moved_normals_.end(), normals.begin(), normals.end());
    for (const BorderEdge& edge : mesh.sides_) {
      for (const size_t corner : corners_of_side(edge)) mesh.moved_normals_.push_back(normals[corner]);
    }
  }
  mesh.find_bounds();
  return mesh;
}

void Mesh::add_side(const BorderEdge& edge, const std::array<glm::uvec3, 2>& quad) {
  const auto repeat = [](auto& values, const auto& places) {
    for (const size_t place : places) {
      const auto value = values[place];
      values.push_back(value);
    }
  };
  const std::array<size_t, 6> corners = corners_of_side(edge);
  triangles_.insert(triangles_.end(), quad.begin(), quad.end());
  repeat(normals_, corners);
  if (!uvs_.empty()) repeat(uvs_, corners);
  if (!tangents_.empty()) repeat(tangents_, corners);
  if (!slots_.empty()) repeat(slots_, std::array<size_t, 2>{edge.triangle, edge.triangle});
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
