// Distances from the points of a grid to triangles.
#pragma once

#include <span>
#include <vector>

#include "job/progress.h"
#include "sphere/vec.h"

namespace velour {

struct Triangle {
  Vec3 corner[3];
};

/// Points first + (i, j, k) step, periodic in x and y.
struct DistanceGrid {
  uint32_t width, height, depth;
  Vec3 first, step;
};

/// To the nearest triangle, of every point, [z][y][x]; all triangles repeat with the grid's periods. Exact within about
/// one and a half steps of the surface; beyond, the nearest of what neighbours are nearest to, handed on ([Dan80]).
/// Call it in the arena that shall do the work; the same bits for any number of threads. Throws Error(cancelled).
std::vector<float> surface_distances(std::span<const Triangle> triangles, const DistanceGrid& grid, Progress& progress);

/// To where `level`, a number for every point, positive outside, changes its sign between neighbours; beside it as from
/// the plane through the places where it does along the axes, beyond as above. Infinite where the sign never changes.
std::vector<float> level_distances(std::span<const float> level, const DistanceGrid& grid, Progress& progress);

/// The point of a triangle that is nearest to `p` [Eri05].
Vec3 nearest_point(const Triangle& triangle, const Vec3& p);

}  // namespace velour
