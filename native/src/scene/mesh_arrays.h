// Arrays from which a mesh is built.
#pragma once

#include <cstdint>
#include <span>
#include <vector>
#include "math/sphere/vec.h"

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
  /// Shapes of a mesh that deforms: `steps` of them in a row, at even times while the shutter is open, each with as
  /// many elements as the array of that name. The arrays above are those of the middle. 0: the mesh keeps its shape.
  uint32_t steps = 0;
  std::span<const Vec3> moved_positions{}, moved_corner_normals{}, moved_vertex_normals{};

  /// The arrays with the shape of a step.
  MeshArrays at(size_t step) const;
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

/// Indices of the triangles that a ray can hit reliably in the middle of their motion. Throws Error(invalid_argument)
/// if a triangle names a missing vertex or corner.
std::vector<uint32_t> usable_triangles(const MeshArrays& arrays);

/// Whether all coordinates are finite and within the ray tracer's range.
bool usable_position(const Vec3& p);
/// Twice the area times the unit normal. In float64, so that tiny and huge meshes neither vanish nor overflow.
Vec3d area_normal(const Vec3& a, const Vec3& b, const Vec3& c);

/// Triangles per parallel task.
inline constexpr size_t kTrianglesOfPiece = 1 << 15;

// Tangents for normal maps, in the convention of the programs that bake them.

/// Tangent at a corner. `direction`: unit, perpendicular to the corner's normal, in which the first texture coordinate
/// grows. The bitangent is `side` cross(normal, direction), where `side` is 1, or -1 if the texture is mirrored.
struct CornerTangent {
  Vec3 direction;
  float side;
};

/// Tangent space of Mikkelsen 2008 ("MikkTSpace") on the given triangles, 3 tangents per triangle. Corners with the
/// same position, normal and texture coordinate share the mean tangent of their triangles of the same side, weighted by
/// angle; triangles without area in texture space take one of those. Unlike in MikkTSpace, triangles that share a
/// vertex but no edge form one group. Normals are unit; non-finite texture coordinates count as 0.
std::vector<CornerTangent> corner_tangents(std::span<const Vec3> positions, std::span<const glm::uvec3> triangles,
                                           std::span<const Vec3> corner_normals, std::span<const Vec2> corner_uvs);

// Border edges of a surface.

/// Edge from corner `corner` of a triangle to the next corner.
struct BorderEdge {
  uint32_t triangle;
  uint32_t corner;
};

/// Edges of the `chosen` triangles that no other chosen triangle shares, in triangle order. Vertices that coincide
/// within a millionth of the surface's extent count as one, so a seam of texture coordinates is not a border.
std::vector<BorderEdge> border_edges(std::span<const Vec3> positions, std::span<const glm::uvec3> triangles,
                                     const std::vector<bool>& chosen);

}  // namespace velour
