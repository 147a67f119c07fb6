// Distances from the points of a grid to surfaces.
#pragma once

#include <span>
#include <vector>

#include "base/progress.h"
#include "math/sphere/vec.h"

namespace velour {

struct Triangle {
  Vec3 corner[3];
};

/// Points first + (i, j, k) step, periodic in x and y.
struct DistanceGrid {
  uint32_t width, height, depth;
  Vec3 first, step;
};

/// Distance of every point, [z][y][x], to the nearest triangle; all triangles repeat with the grid's periods. Exact
/// within about one and a half steps of the surface; farther points take the nearest of their neighbors' nearest points
/// ([Dan80]). Runs in the calling task arena; the same bits for any number of threads. Throws Error(cancelled).
std::vector<float> surface_distances(std::span<const Triangle> triangles, const DistanceGrid& grid, Progress& progress);

/// Distance of every point to where `level`, one number per point and positive outside, changes its sign: next to a
/// sign change, to the plane through the sign changes along the axes; farther away, propagated as in
/// surface_distances(). Infinite if the sign never changes.
std::vector<float> level_distances(std::span<const float> level, const DistanceGrid& grid, Progress& progress);

/// The point of a triangle that is nearest to `p` [Eri05].
Vec3 nearest_point(const Triangle& triangle, const Vec3& p);

}  // namespace velour
