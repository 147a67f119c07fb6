// Reads meshes from files of any supported format.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>
#include "math/sphere/vec.h"
#include "scene/mesh.h"

namespace velour {

// Wavefront OBJ files.

/// Reads all shapes of the file as one mesh. Polygons are cut into triangles; each face keeps the normals and texture
/// coordinates that it names. As in Blender's importer, a face without normals is smooth if the file has no normals and
/// the face is in a smoothing group, else flat; each object ("o") begins flat. Materials, curves and points are not
/// read. The mesh's warnings count faces without the normals or texture coordinates that others have. Throws Error(io,
/// bad_data) with the file's name and the line at fault.
Mesh read_obj(const std::string& path);

// Triangulation of polygons.

/// Cuts polygons, convex or not, into count - 2 triangles by ear clipping (Meisters 1975) in the plane of the polygon's
/// normal (Newell). Outlines may touch themselves at corners and along edges, as bridges to holes do; edges traversed
/// in both directions give triangles without area. Up to the choice of diagonals, the result does not depend on the
/// origin or the first corner. Self-intersecting polygons also give some triangles. Reuses its memory between calls.
class PolygonTriangles {
 public:
  /// Maximum number of corners. The time grows with its square.
  static constexpr size_t kMaxCorners = 20000;

  /// `corners`: positions of the polygon's corners in order, at least 3 and at most kMaxCorners. Returns triangles of
  /// indices into `corners`, valid until the next call.
  std::span<const glm::uvec3> cut(std::span<const Vec3> corners);

 private:
  void project(std::span<const Vec3> corners);
  void cut_quad();
  void clip_ears();
  double turn(uint32_t a, uint32_t b, uint32_t c) const;
  bool is_spike(uint32_t corner) const;
  int winding(const glm::dvec2& point, uint32_t start) const;
  bool is_ear(uint32_t corner);
  uint32_t flattest(uint32_t start) const;

  std::vector<glm::dvec2> points_;  // counterclockwise
  uint64_t examined_ = 0;           // corners, in the search for ears
  std::vector<uint32_t> next_, previous_;
  std::vector<glm::uvec3> triangles_;
};

// Stanford PLY files, ASCII and binary in both byte orders.

/// Reads vertices (x, y, z), with normals (nx, ny, nz) and texture coordinates (s, t or u, v) if present, and polygons
/// (vertex_indices or vertex_index), cut into triangles, with texture coordinates of corners (texcoord) if present, and
/// triangle strips (tristrips). Elements may come in any order; other elements and properties are skipped.
/// Throws Error(io, bad_data) with the file's name; never reads or allocates more than the file's size justifies.
Mesh read_ply(const std::string& path);

/// Reads PLY if the file begins with "ply" or the extension is .ply (in any case), else Wavefront OBJ. Throws Error
/// with the file's name; for other formats, it names the format.
Mesh read_mesh(const std::string& path);

// Builds many meshes at once.

/// Builds a Mesh from each entry of `arrays`, in parallel.
std::vector<Mesh> build_meshes(std::span<const MeshArrays> arrays);

}  // namespace velour
