// A triangle mesh in its own (object) space, and the arrays from which it is built.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>
#include "base/warning.h"
#include "math/sphere/affine.h"
#include "math/sphere/vec.h"
#include "scene/motion.h"

namespace velour {

// Arrays from which a mesh is built.

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

/// Extent of a shell along the normal of its surface, in world-space meters; bottom equals top for no shell.
struct ShellHeights {
  float bottom = 0, top = 0;
};

/// Immutable except for make_tangents(). Leaves out triangles that a ray cannot hit reliably: those without area or
/// with a corner that is not finite or out of reach. Replaces zero or non-finite shading normals by the triangle's own.
class Mesh {
 public:
  /// Copies the arrays. Throws Error(invalid_argument) if lengths disagree or a triangle names a missing vertex.
  explicit Mesh(const MeshArrays& arrays);

  /// The top surface of the shells over this mesh. Vertices of triangles of slot s move by `heights[s].top` world-space
  /// meters along their normals, the means of their corner normals in slots with a shell. `metric` is M^T M of the
  /// object-to-world matrix M. Slots beyond the list use its last entry. Triangles without a shell stay and are
  /// detached from the others. Sides follow this mesh's triangles, where the moved surface ends: two triangles per
  /// border edge, from bottom to top, facing outwards.
  Mesh lifted(std::span<const ShellHeights> heights, const Mat3& metric) const;

  bool has_sides() const { return !sides_.empty(); }
  /// Triangles from this index on are sides.
  uint32_t first_side() const { return static_cast<uint32_t>(triangles_.size() - 2 * sides_.size()); }
  /// A point on a side: the border point above it, on a triangle of the top, and its height from 0 at the bottom to 1
  /// at the top.
  struct SidePoint {
    uint32_t triangle;
    Vec2 uv;
    float height;
  };
  SidePoint on_side(uint32_t triangle, const Vec2& uv) const;

  std::span<const Vec3> positions() const { return positions_; }
  /// Whether its shape changes while the shutter is open. All that is not asked for at a time is of the middle.
  bool deforms() const { return steps_ > 0; }
  /// Number of shapes at even times from 0 to 1; they are linear in between. 0 if it does not deform.
  uint32_t steps() const { return steps_; }
  /// The positions of all shapes in a row.
  std::span<const Vec3> moved_positions() const { return moved_positions_; }
  /// Bounds of all triangles in object space, whatever the time.
  const Bounds& bounds() const { return bounds_; }
  std::span<const glm::uvec3> triangles() const { return triangles_; }
  /// Number of input triangles that were left out.
  uint32_t dropped() const { return dropped_; }
  bool has_uvs() const { return !uvs_.empty(); }
  /// Requires has_uvs(). The first set stands in for a missing one.
  std::span<const Vec2, 3> corner_uvs(uint32_t triangle, size_t set = 0) const {
    const size_t corner = 3 * static_cast<size_t>(triangle);
    const bool other = set > 0 && set <= more_uvs_.size() && corner < more_uvs_[set - 1].size();
    return std::span<const Vec2, 3>(other ? &more_uvs_[set - 1][corner] : &uvs_[corner], 3);
  }
  /// Color at barycentric weights (u, v) of corners 1 and 2; black for a missing set.
  Rgb color(uint32_t triangle, const Vec2& uv, size_t set) const;

  // In object space; at barycentric weights (u, v) of corners 1 and 2:
  std::array<Vec3, 3> corners(uint32_t triangle, float time = kMiddleTime) const;
  Vec3 position(uint32_t triangle, const Vec2& uv, float time = kMiddleTime) const;
  /// Like position(), but of absolute coordinates; the rounding error of position() is proportional to it.
  Vec3 position_magnitude(uint32_t triangle, const Vec2& uv, float time = kMiddleTime) const;
  /// Not normalized.
  Vec3 shading_normal(uint32_t triangle, const Vec2& uv, float time = kMiddleTime) const;
  /// Unit normals.
  std::array<Vec3, 3> corner_normals(uint32_t triangle, float time = kMiddleTime) const;
  /// Direction of d position / d (first coordinate of `map` times the texture coordinates), not normalized; zero
  /// without texture coordinates or where they are degenerate.
  Vec3 tangent(uint32_t triangle, const Mat2& map = Mat2(1.0f), float time = kMiddleTime) const;
  /// Like tangent(), but from MikkTSpace's tangents, which are smooth where triangles share corners. `map` rotates it
  /// on the surface, ignoring the stretch of the texture. Requires has_tangents().
  Vec3 smooth_tangent(uint32_t triangle, const Vec2& uv, const Mat2& map = Mat2(1.0f), float time = kMiddleTime) const;
  uint32_t material_slot(uint32_t triangle) const { return slots_.empty() ? 0 : slots_[triangle]; }
  /// Computes the tangents for relief() and smooth_tangent(), unless they exist or there are no texture coordinates.
  void make_tangents();
  bool has_tangents() const { return !tangents_.empty(); }
  /// Columns: tangent, bitangent and normal for a normal map in object space, interpolated and not normalized. All
  /// three transform like normals. The tangent keeps its direction while the mesh deforms, as in Cycles. Requires
  /// has_tangents().
  Mat3 relief(uint32_t triangle, const Vec2& uv, float time = kMiddleTime) const;
  uint64_t bytes() const;
  /// About the file: what of it was left out or replaced.
  const std::vector<Warning>& warnings() const { return warnings_; }
  void add_warning(Warning warning) { warnings_.push_back(std::move(warning)); }

 private:
  /// Copies the data of triangles [begin, end) of this mesh; `kept`: their indices in `arrays`.
  void copy_triangles(const MeshArrays& arrays, std::span<const uint32_t> kept, size_t begin, size_t end);
  void copy_uvs(const MeshArrays& arrays, size_t from, size_t to);
  void copy_colors(const MeshArrays& arrays, size_t from, size_t to);
  void find_bounds();
  void copy_shapes(const MeshArrays& arrays, std::span<const uint32_t> kept);
  /// Replaces missing or unusable normals by those of triangles at `positions`, and normalizes all.
  void finish_normals(const MeshArrays& arrays, std::span<const uint32_t> kept, std::span<const Vec3> positions,
                      std::span<Vec3> normals) const;
  std::vector<Vec3d> summed_normals(std::span<const Vec3> positions) const;
  /// `quad`: (bottom a, bottom b, top b) and (bottom a, top b, top a) over the edge from a to b.
  void add_side(const BorderEdge& edge, const std::array<glm::uvec3, 2>& quad);

  std::vector<Vec3> positions_;
  Bounds bounds_;
  std::vector<glm::uvec3> triangles_;
  std::vector<Vec3> normals_;  // 3 per triangle
  uint32_t steps_ = 0;
  std::vector<Vec3> moved_positions_;        // by step and vertex
  std::vector<Vec3> moved_normals_;          // by step, 3 per triangle
  std::vector<bool> flat_;                   // by triangle of a mesh that deforms: shaded with its own normal
  std::vector<Vec2> uvs_;                    // 3 per triangle, or none
  std::vector<std::vector<Vec2>> more_uvs_;  // further sets, without sides
  std::vector<Vec2> relief_uvs_;             // 3 per triangle until tangents exist; none: the first set is used
  std::vector<std::vector<Rgb>> colors_;     // sets of 3 per triangle, without sides
  std::vector<uint32_t> slots_;
  std::vector<CornerTangent> tangents_;  // 3 per triangle, or none
  std::vector<BorderEdge> sides_;        // border edge of the top above each side
  uint32_t dropped_ = 0;
  std::vector<Warning> warnings_;
};

}  // namespace velour
