// Gravel: a bed of pebbles.
#pragma once

#include <cstdint>
#include <vector>
#include "capture/tile/tile.h"
#include "math/sphere/vec.h"

namespace velour {

// Packing of balls in a box that is periodic in x and y.

struct Ball {
  Vec3d center;
  double radius;
};

struct PackingOptions {
  double period = 1;  // along x and y; at least four times the largest radius
  double largest_radius = 0.1;
  double smallest_radius = 0.05;
  double volume = 0.1;  // balls are dropped until their total volume reaches this
  uint64_t seed = 0;
};

/// Balls dropped one by one, each at the one of a few hundred random positions where it comes to rest lowest; the floor
/// is z = 0. No two intersect, periodic copies included. Centers lie in [0, period).
std::vector<Ball> pack_balls(const PackingOptions& options);

/// Shortest vector from a to b, across the border if that is shorter.
Vec3d periodic_difference(const Vec3d& a, const Vec3d& b, double period);

/// Balls (irregularity 0) or stones cut from them, on the opaque floor z = 0. Thickness is the approximate depth of the
/// bed in pitches.
TileParts make_gravel(const TileShape& shape);

/// The balls that the stones are cut from.
std::vector<Ball> gravel_balls(const TileShape& shape);

}  // namespace velour
