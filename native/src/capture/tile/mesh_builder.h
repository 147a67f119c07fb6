// Builds a tile's mesh from curved surfaces.
#pragma once

#include <functional>

#include "capture/tile/tile.h"

namespace velour {

/// How a grid of points continues beyond its last line.
struct GridEnd {
  bool joined = false;  // the line after the last is the first
  Vec3d step{0.0};      // otherwise: the last line is the first one shifted by a period

  static GridEnd join() { return {.joined = true}; }
  static GridEnd repeat(const Vec3d& step) { return {.step = step}; }
};

class MeshBuilder {
 public:
  /// Point for u, v in [0, 1); d/du x d/dv points outward.
  using Surface = std::function<Vec3d(double u, double v)>;
  struct Grid {
    int cells_u, cells_v;
    GridEnd end_u, end_v;
    uint32_t slot;
  };
  void add_grid(const Grid& grid, const Surface& surface);

  /// Point in a direction from the center, for a closed surface that each ray from the center meets once.
  using Globe = std::function<Vec3d(const Vec3d& direction)>;
  /// `around`: number of meridians (even); half as many steps from pole to pole.
  void add_globe(int around, uint32_t slot, const Globe& globe);

  /// Returns the mesh. Its normals are means over the surrounding triangles weighted by angle, as in Blender, also
  /// across borders of the period.
  TileMesh finish();

 private:
  uint32_t add_vertex(const Vec3d& position);
  void add_triangle(const glm::uvec3& corners, const Vec2 (&uvs)[3], uint32_t slot);
  void add_cell(const Grid& grid, int i, int j, uint32_t first);
  void add_pole(int around, uint32_t pole, uint32_t ring, bool north, uint32_t slot);

  TileMesh mesh_;
  std::vector<uint32_t> original_;  // the vertex that each vertex duplicates, or itself
};

}  // namespace velour
