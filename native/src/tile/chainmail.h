// Rings of wire, each through four others.
#pragma once

#include "tile/tile.h"

namespace velour {

/// Rows of rings along x. All rings of a row lean the same way about y, those of the next row the other way, shifted by
/// half a pitch; each ring passes through its two neighbours in the row before and its two in the row after.
///
/// A ring's radius (to the middle of the wire) is 0.8 pitches and rows are a pitch apart: of all lattices of this kind
/// about the one whose circles stay farthest from each other, for the lean below.
inline constexpr double kRingRadius = 0.8;  // pitches
inline constexpr double kRingLean = 0.6;    // radians between a ring's axis and +z
/// The circles' least distance is 0.3987 pitches; a thicker wire would meet itself.
inline constexpr double kThickestWire = 0.39;  // diameter, pitches

/// Circles of `count` x `count` rings; thickness is the diameter of the wire.
TileParts make_chainmail(const TileShape& shape);

/// The middle line of a ring: center + radius (cos t side + sin t along), around axis.
struct Ring {
  Vec3d center, side, along, axis;
  double radius;
};
Ring ring_at(const TileShape& shape, int column, int row);

}  // namespace velour
