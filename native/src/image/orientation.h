// How the stored rows and columns of a picture lie in the picture that people see.
#pragma once

#include <string>

#include "image/picture.h"

namespace velour {

/// The numbers of EXIF and TIFF (tag 274): where the stored row 0 and column 0 lie.
enum class Orientation {
  normal = 1,       // top, left
  mirrored = 2,     // top, right
  turned_180 = 3,   // bottom, right
  flipped = 4,      // bottom, left
  transposed = 5,   // left, top
  turned_cw = 6,    // right, top: to be turned clockwise by 90 degrees
  transversed = 7,  // right, bottom
  turned_ccw = 8,   // left, bottom: to be turned counterclockwise by 90 degrees
};

inline bool swaps_sides(Orientation o) { return o >= Orientation::transposed; }

/// `stored` with the top row first in memory; returns the upright picture, with the top row first too.
Picture upright(Picture stored, Orientation orientation);

/// "turned by 90 degrees", for sentences.
std::string name_of(Orientation orientation);

}  // namespace velour
