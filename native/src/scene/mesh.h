// A triangle mesh in its own (object) space.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/corner_tangents.h"
#include "sphere/vec.h"

namespace velour {

/// Borrowed arrays that a Mesh is built from. Empty means: not given.
struct MeshArrays {
  std::span<const Vec3> positions{};
  std::span<const glm::uvec3> triangles{};
  std::span<const Vec3> corner_normals{};      // 3 a triangle; any length but zero
  std::span<const Vec2> corner_uvs{};          // 3 a triangle
  std::span<const uint32_t> material_slots{};  // 1 a triangle; none: slot 0
  std::span<const uint8_t> smooth{};           // 1 a triangle; used without corner_normals; none: all smooth
};

/// Immutable but for make_tangents(). Triangles that a ray cannot hit reliably - a corner that is not finite or out of
/// reach, no area
/// - are left out. Zero or non-finite shading normals are replaced by the triangle's own.
class Mesh {
 public:
  /// Copies. Throws Error(invalid_argument) when lengths disagree or a triangle names a vertex that is not there.
  explicit Mesh(const MeshArrays& arrays);

  /// The surface that lies over this one: every vertex of the triangles of slot s is moved along its normal - the mean
  /// of its corners' in such slots - until it is `height[s]` higher in the world, where the map from the object to the
  /// world has `metric`, its transpose times itself. Slots of height 0 and those beyond stay, and part from the others.
  Mesh lifted(std::span<const float> height, const Mat3& metric) const;

  std::span<const Vec3> positions() const { return positions_; }
  std::span<const glm::uvec3> triangles() const { return triangles_; }
  /// How many triangles of the input were left out.
  uint32_t dropped() const { return dropped_; }
  bool has_uvs() const { return !uvs_.empty(); }
  /// Only with has_uvs().
  std::span<const Vec2, 3> corner_uvs(uint32_t triangle) const {
    return std::span<const Vec2, 3>(&uvs_[3 * static_cast<size_t>(triangle)], 3);
  }

  /// At barycentric weights (u, v) of corners 1 and 2. Object space; not normalised.
  Vec3 position(uint32_t triangle, const Vec2& uv) const;
  /// The same sum over absolute coordinates: what the rounding error of position() is proportional to.
  Vec3 position_magnitude(uint32_t triangle, const Vec2& uv) const;
  Vec3 shading_normal(uint32_t triangle, const Vec2& uv) const;
  /// Unit.
  std::span<const Vec3, 3> corner_normals(uint32_t triangle) const {
    return std::span<const Vec3, 3>(&normals_[3 * static_cast<size_t>(triangle)], 3);
  }
  /// Along d position / d (first coordinate of `map` times the texture coordinates); zero without uvs or where they are
  /// degenerate.
  Vec3 tangent(uint32_t triangle, const Mat2& map = Mat2(1.0f)) const;
  uint32_t material_slot(uint32_t triangle) const { return slots_.empty() ? 0 : slots_[triangle]; }
  /// Makes what relief() needs, where there are texture coordinates and it is not there yet.
  void make_tangents();
  bool has_tangents() const { return !tangents_.empty(); }
  /// Columns: tangent, bitangent and normal of a normal map, object space, interpolated and not normalised. Only with
  /// has_tangents(). Turned as normals are, they turn what the map says.
  Mat3 relief(uint32_t triangle, const Vec2& uv) const;
  uint64_t bytes() const;

 private:
  void keep_good_triangles(const MeshArrays& arrays);
  void compute_normals(std::span<const uint8_t> smooth);

  std::vector<Vec3> positions_;
  std::vector<glm::uvec3> triangles_;
  std::vector<Vec3> normals_;  // 3 a triangle
  std::vector<Vec2> uvs_;      // 3 a triangle, or none
  std::vector<uint32_t> slots_;
  std::vector<CornerTangent> tangents_;  // 3 a triangle, or none
  uint32_t dropped_ = 0;
};

}  // namespace velour
