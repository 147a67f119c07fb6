// Meshes of curved surfaces, and noise that repeats with the tile: the parts of all tiles.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include "capture/tile/tile.h"

namespace velour {

// Builds a tile's mesh from curved surfaces.

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

// Random values and smooth noise that repeat with the cell of a tile.

/// Value noise: uniform random numbers in [0, 1) at the points of a lattice, interpolated with continuous slopes, never
/// outside [0, 1). Repeats after `cells` lattice cells along each axis.
struct PeriodicNoise {
  uint64_t seed = 0;
  uint64_t stream = 0;  // selects independent noise for the same seed
  glm::ivec2 cells{1, 1};

  /// `at` in periods: at + (1, 0) and at + (0, 1) give the same value.
  double operator()(const glm::dvec2& at) const;
};

}  // namespace velour
