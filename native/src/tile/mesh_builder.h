// Puts a tile's mesh together from curved surfaces.
#pragma once

#include <functional>

#include "tile/tile.h"

namespace velour {

/// How a grid of points goes on beyond its last line.
struct GridEnd {
  bool joined = false;  // the line after the last is the first
  Vec3d step{0.0};      // otherwise: the last line is the first one moved by a period

  static GridEnd join() { return {.joined = true}; }
  static GridEnd repeat(const Vec3d& step) { return {.step = step}; }
};

class MeshBuilder {
 public:
  /// A point for u, v in [0, 1); d/du x d/dv points outwards.
  using Surface = std::function<Vec3d(double u, double v)>;
  struct Grid {
    int cells_u, cells_v;
    GridEnd end_u, end_v;
    uint32_t slot;
  };
  void add_grid(const Grid& grid, const Surface& surface);

  /// A point in a direction from the middle, for a closed surface that each ray from the middle meets once.
  using Globe = std::function<Vec3d(const Vec3d& direction)>;
  /// `around` meridians (even), half as many steps from pole to pole; slot `slot`.
  void add_globe(int around, uint32_t slot, const Globe& globe);

  /// The mesh, with normals that are the means of the triangles around, weighted by their angles as in Blender, across
  /// borders of the period too.
  TileMesh finish();

 private:
  uint32_t add_vertex(const Vec3d& position);
  void add_triangle(const glm::uvec3& corners, const Vec2 (&uvs)[3], uint32_t slot);
  void add_cell(const Grid& grid, int i, int j, uint32_t first);
  void add_pole(int around, uint32_t pole, uint32_t ring, bool north, uint32_t slot);

  TileMesh mesh_;
  std::vector<uint32_t> original_;  // the vertex that a vertex repeats, or itself
};

}  // namespace velour
