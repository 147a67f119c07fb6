// Arrays from which a mesh is built.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sphere/vec.h"

namespace velour {

/// Borrowed arrays; an empty one is not given.
struct MeshArrays {
  std::span<const Vec3> positions{};
  std::span<const glm::uvec3> triangles{};
  std::span<const Vec3> corner_normals{};      // 3 per triangle; need not be unit; zero: the triangle's own normal
  std::span<const Vec2> corner_uvs{};          // 3 per triangle
  std::span<const Vec2> more_uvs{};            // further sets of them, one after the other
  std::span<const Vec2> relief_uvs{};          // 3 per triangle, for tangents of normal maps; none: corner_uvs
  std::span<const Rgb> corner_colors{};        // sets of 3 per triangle, one after the other; non-finite ones become 0
  std::span<const uint32_t> material_slots{};  // 1 per triangle; none: slot 0
  std::span<const uint8_t> smooth{};           // 1 per triangle; used without corner_normals; none: all smooth
  /// Vertex of each face corner. If given, `triangles` index face corners, and the arrays of 3 entries per triangle
  /// have 1 per face corner instead, so that they need not be expanded to the triangles that faces are cut into.
  std::span<const uint32_t> corner_vertices{};
  /// Used for smooth triangles without corner_normals; none: area-weighted means of the triangles around each vertex.
  std::span<const Vec3> vertex_normals{};

  /// Throws Error(invalid_argument) if lengths disagree.
  void check() const;
  size_t corners() const { return corner_vertices.empty() ? 3 * triangles.size() : corner_vertices.size(); }
  size_t corner(size_t triangle, int k) const {
    return corner_vertices.empty() ? 3 * triangle + static_cast<size_t>(k) : triangles[triangle][k];
  }
  /// The given normal; (0, 0, 0) if none is given or the triangle is flat.
  Vec3 normal(size_t triangle, int k, uint32_t vertex) const;
  bool is_smooth(size_t triangle) const { return smooth.empty() || smooth[triangle] != 0; }
};

/// Indices of the triangles that a ray can hit reliably. Throws Error(invalid_argument) if a triangle names a missing
/// vertex or corner.
std::vector<uint32_t> usable_triangles(const MeshArrays& arrays);

/// Whether all coordinates are finite and within the ray tracer's range.
bool usable_position(const Vec3& p);
/// Twice the area times the unit normal. In float64, so that tiny and huge meshes neither vanish nor overflow.
Vec3d area_normal(const Vec3& a, const Vec3& b, const Vec3& c);

/// Triangles per parallel task.
inline constexpr size_t kTrianglesOfPiece = 1 << 15;

}  // namespace velour
