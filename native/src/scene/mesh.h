// A triangle mesh in its own (object) space.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scene/border_edges.h"
#include "scene/bounds.h"
#include "scene/corner_tangents.h"
#include "scene/mesh_arrays.h"
#include "sphere/vec.h"

namespace velour {

/// From where to where a shell reaches over its surface, metres of the world; a surface without one: as low as high.
struct ShellHeights {
  float bottom = 0, top = 0;
};

/// Immutable but for make_tangents(). Triangles that a ray cannot hit reliably - a corner that is not finite or out of
/// reach, no area - are left out. Zero or non-finite shading normals are replaced by the triangle's own.
class Mesh {
 public:
  /// Copies. Throws Error(invalid_argument) when lengths disagree or a triangle names a vertex that is not there.
  explicit Mesh(const MeshArrays& arrays);

  /// The surface that lies over this one: every vertex of the triangles of slot s is moved along its normal - the mean
  /// of its corners' in such slots - until it is `heights[s].top` higher in the world, where the map from the object to
  /// the world has `metric`, its transpose times itself. Slots without height and those beyond stay, and part from the
  /// others. Behind the triangles of this mesh come sides, where what is moved ends: two triangles a border edge, from
  /// bottom to top, their front outside.
  Mesh lifted(std::span<const ShellHeights> heights, const Mat3& metric) const;

  bool has_sides() const { return !sides_.empty(); }
  /// Triangles from here on are sides.
  uint32_t first_side() const { return static_cast<uint32_t>(triangles_.size() - 2 * sides_.size()); }
  /// A point of a side: that of the border over it, of one of the other triangles, and how high it lies, from 0 at the
  /// bottom to 1.
  struct SidePoint {
    uint32_t triangle;
    Vec2 uv;
    float height;
  };
  SidePoint on_side(uint32_t triangle, const Vec2& uv) const;

  std::span<const Vec3> positions() const { return positions_; }
  /// Of the corners of all triangles, object space.
  const Bounds& bounds() const { return bounds_; }
  std::span<const glm::uvec3> triangles() const { return triangles_; }
  /// How many triangles of the input were left out.
  uint32_t dropped() const { return dropped_; }
  bool has_uvs() const { return !uvs_.empty(); }
  /// Only with has_uvs(). Of a set that is not there, the first.
  std::span<const Vec2, 3> corner_uvs(uint32_t triangle, size_t set = 0) const {
    const size_t corner = 3 * static_cast<size_t>(triangle);
    const bool other = set > 0 && set <= more_uvs_.size() && corner < more_uvs_[set - 1].size();
    return std::span<const Vec2, 3>(other ? &more_uvs_[set - 1][corner] : &uvs_[corner], 3);
  }
  /// At barycentric weights (u, v) of corners 1 and 2; black of a set that is not there.
  Rgb color(uint32_t triangle, const Vec2& uv, size_t set) const;

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
  /// The same, but of MikkTSpace's tangents: smooth where triangles share corners. `map` turns it on the surface, and
  /// knows nothing of how far the picture is stretched there. Only with has_tangents().
  Vec3 smooth_tangent(uint32_t triangle, const Vec2& uv, const Mat2& map = Mat2(1.0f)) const;
  uint32_t material_slot(uint32_t triangle) const { return slots_.empty() ? 0 : slots_[triangle]; }
  /// Makes what relief() and smooth_tangent() need, where there are texture coordinates and it is not there yet.
  void make_tangents();
  bool has_tangents() const { return !tangents_.empty(); }
  /// Columns: tangent, bitangent and normal of a normal map, object space, interpolated and not normalised. Only with
  /// has_tangents(). Turned as normals are, they turn what the map says.
  Mat3 relief(uint32_t triangle, const Vec2& uv) const;
  uint64_t bytes() const;
  /// Sentences with the file's name: what of it was left out or replaced.
  const std::vector<std::string>& notes() const { return notes_; }
  void add_note(std::string sentence) { notes_.push_back(std::move(sentence)); }

 private:
  /// Copies what belongs to triangles [begin, end) of this mesh; `kept`: their numbers in `arrays`.
  void copy_triangles(const MeshArrays& arrays, std::span<const uint32_t> kept, size_t begin, size_t end);
  void copy_uvs(const MeshArrays& arrays, size_t from, size_t to);
  void copy_colors(const MeshArrays& arrays, size_t from, size_t to);
  void find_bounds();
  /// Replaces normals that are not given or not usable, of triangles [begin, end).
  void finish_normals(const MeshArrays& arrays, std::span<const uint32_t> kept, std::span<const Vec3d> sums,
                      size_t begin, size_t end);
  std::vector<Vec3d> summed_normals() const;
  /// `quad`: (bottom a, bottom b, top b), (bottom a, top b, top a) over the edge from a to b.
  void add_side(const BorderEdge& edge, const std::array<glm::uvec3, 2>& quad);

  std::vector<Vec3> positions_;
  Bounds bounds_;
  std::vector<glm::uvec3> triangles_;
  std::vector<Vec3> normals_;                // 3 a triangle
  std::vector<Vec2> uvs_;                    // 3 a triangle, or none
  std::vector<std::vector<Vec2>> more_uvs_;  // other sets of them, but for sides
  std::vector<Vec2> relief_uvs_;             // 3 a triangle until there are tangents; none: the first set
  std::vector<std::vector<Rgb>> colors_;     // sets of 3 a triangle, but for sides
  std::vector<uint32_t> slots_;
  std::vector<CornerTangent> tangents_;  // 3 a triangle, or none
  std::vector<BorderEdge> sides_;        // of triangles of the top
  uint32_t dropped_ = 0;
  std::vector<std::string> notes_;
};

}  // namespace velour
