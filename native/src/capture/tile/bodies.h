// Tiles of separate bodies: chain mail and gravel.
#pragma once

#include <cstdint>
#include <vector>
#include "capture/tile/tile.h"
#include "math/sphere/vec.h"

namespace velour {

// Chain mail: rings of wire, each linked with four others.

/// Rows of rings run along x. All rings of a row lean the same way about y, those of the next row the other way and
/// shifted by half a pitch; each ring links with two neighbors in the previous row and two in the next.
///
/// A ring's radius (to the middle of the wire) is 0.8 pitches and rows are one pitch apart. For the lean below, this
/// roughly maximizes the distance between the circles among lattices of this kind.
inline constexpr double kRingRadius = 0.8;  // pitches
inline constexpr double kRingLean = 0.6;    // radians between a ring's axis and +z
/// The minimum distance between circles is 0.3987 pitches; thicker wires would intersect.
inline constexpr double kThickestWire = 0.39;  // diameter, pitches

/// `count` x `count` circular rings; thickness is the diameter of the wire.
TileParts make_chainmail(const TileShape& shape);

/// Center line of a ring: center + radius (cos t side + sin t along), around axis.
struct Ring {
  Vec3d center, side, along, axis;
  double radius;
};
Ring ring_at(const TileShape& shape, int column, int row);

// Gravel: a bed of pebbles.

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
