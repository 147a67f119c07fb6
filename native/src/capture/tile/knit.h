// Knitted and piled cloth.
#pragma once

#include "capture/tile/tile.h"

namespace velour {

/// Plain knit (jersey), seen from its face. A course of yarn runs along x as
///
///   x = t / 2 pi + a sin 2t,  y = h cos t,  z = -d cos 2t   (in wales, one loop per period of t),
///
/// and the next course, kCourse wales further along y, passes through its loops. The shape below roughly maximizes the
/// distance between the middle lines of courses and of the two sides of a loop, 0.249 wales, for this spacing.
inline constexpr double kCourse = 0.6;  // distance of courses, in wales
inline constexpr double kLoopWidth = 0.2366, kLoopHeight = 0.5113, kLoopDepth = 0.2068;  // a, h, d in wales
/// Thicker yarns would intersect.
inline constexpr double kThickestYarn = 0.24;  // diameter, wales

/// `count` wales and 5/3 as many courses. Thickness is the diameter of the yarn, which is three twisted plies.
TileParts make_knit(const TileShape& shape);

/// Velvet: upright fibers, one per pitch and side, on the opaque ground z = 0. Thickness is their height in pitches,
/// gap the distance between neighbors; irregularity jitters them within the gap and makes them lean, all within an area
/// the same way, by up to half their height.
TileParts make_velvet(const TileShape& shape);

}  // namespace velour
