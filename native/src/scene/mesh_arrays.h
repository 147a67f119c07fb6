// What a mesh is built from.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sphere/vec.h"

namespace velour {

/// Borrowed arrays. Empty means: not given.
struct MeshArrays {
  std::span<const Vec3> positions{};
  std::span<const glm::uvec3> triangles{};
  std::span<const Vec3> corner_normals{};      // 3 a triangle; any length but zero
  std::span<const Vec2> corner_uvs{};          // 3 a triangle
  std::span<const Vec2> more_uvs{};            // other sets of them, one after the other
  std::span<const Vec2> relief_uvs{};          // 3 a triangle: what tangents of normal maps follow; none: corner_uvs
  std::span<const Rgb> corner_colors{};        // sets of 3 a triangle, one after the other; what is not finite is 0
  std::span<const uint32_t> material_slots{};  // 1 a triangle; none: slot 0
  std::span<const uint8_t> smooth{};           // 1 a triangle; used without corner_normals; none: all smooth
  /// Given: `triangles` name corners of faces, these are the vertices of those, and what is said to be 3 a triangle is
  /// 1 a corner: no array need be spread over the triangles that faces are cut into.
  std::span<const uint32_t> corner_vertices{};
  /// Used without corner_normals, of smooth triangles; none: means of the triangles about a vertex, by area.
  std::span<const Vec3> vertex_normals{};

  /// Throws Error(invalid_argument) when lengths disagree.
  void check() const;
  size_t corners() const { return corner_vertices.empty() ? 3 * triangles.size() : corner_vertices.size(); }
  size_t corner(size_t triangle, int k) const {
    return corner_vertices.empty() ? 3 * triangle + static_cast<size_t>(k) : triangles[triangle][k];
  }
  /// (0, 0, 0): none is given, or the triangle is flat.
  Vec3 normal(size_t triangle, int k, uint32_t vertex) const;
  bool is_smooth(size_t triangle) const { return smooth.empty() || smooth[triangle] != 0; }
};

/// Triangles that a ray can hit reliably, by number. Throws Error(invalid_argument) when one names a vertex, corner or
/// face that is not there.
std::vector<uint32_t> usable_triangles(const MeshArrays& arrays);

/// Whether a coordinate is finite and within the ray tracer's reach.
bool usable_position(const Vec3& p);
/// Twice the area times the unit normal, in float64: edges of tiny and huge meshes neither vanish nor overflow.
Vec3d area_normal(const Vec3& a, const Vec3& b, const Vec3& c);

/// Triangles that one thread looks at in one go.
inline constexpr size_t kTrianglesOfPiece = 1 << 15;

}  // namespace velour
