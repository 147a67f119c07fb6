// Chain mail: rings of wire, each linked with four others.
#pragma once

#include "capture/tile/tile.h"

namespace velour {

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

}  // namespace velour
