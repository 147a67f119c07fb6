#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "scene/mesh.h"

namespace velour {

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
