// Tiles of cloth and leather: woven, knitted and piled.
#pragma once

#include "capture/tile/tile.h"

namespace velour {

// Woven tiles: two sets of yarns that cross at right angles.
//
// Every cross section of a yarn is an upright ellipse with half-axes a (sideways) and b (up); only its center moves,
// along z. A yarn's shadow on the cloth is therefore a straight strip, and the share of open area is exactly (gap /
// pitch)^2. At distance d from a crossing, the center of the upper yarn is at least b sqrt(1 - (d / a)^2) above the
// middle plane of the cloth, and the lower yarn as far below: the condition for the two not to intersect.

/// Height of a yarn's center between a crossing that it passes above, at u = 0, and one that it passes below, at u = 1,
/// as a share of its height at a crossing: c (3 - c^2) / 2 with c = cos(pi u). Slope and curvature vanish at both ends,
/// so that the yarn continues straight over a float.
double yarn_wave(double u);

/// Height of a yarn's center at a crossing, in half-heights of the yarn: the minimum, and at least 1, that keeps yarns
/// of half-width `half_width` (pitches, below 0.5) apart.
double yarn_amplitude(double half_width);

TileParts make_weave(const TileShape& shape);
TileParts make_twill(const TileShape& shape);
TileParts make_denim(const TileShape& shape);
/// Five-end satin: the warp floats over four wefts, so that it covers the face.
TileParts make_satin(const TileShape& shape);
/// The plain weave, with cords far apart.
TileParts make_net(const TileShape& shape);

// Knitted and piled cloth.

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

// Sheets without holes: corduroy and leather.

/// Ribs of pile along y, parabolas `thickness` high, with flat grooves `gap` wide between them at z = 0. Irregularity
/// makes tufts of unequal height.
TileParts make_corduroy(const TileShape& shape);

/// Grained leather: the cells of a Voronoi diagram of jittered points, one per pitch and side, as cushions `thickness`
/// high, with creases about `gap` wide between them that reach down to z = 0. Irregularity jitters the points and
/// lowers some cushions.
TileParts make_leather(const TileShape& shape);

}  // namespace velour
