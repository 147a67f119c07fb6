// Orientation of a picture's stored rows and columns in the upright picture.
#pragma once

#include <string>

#include "image/picture.h"

namespace velour {

/// Values of EXIF and TIFF (tag 274): the sides of the upright picture where the stored row 0 and column 0 lie.
enum class Orientation {
  normal = 1,       // top, left
  mirrored = 2,     // top, right
  turned_180 = 3,   // bottom, right
  flipped = 4,      // bottom, left
  transposed = 5,   // left, top
  turned_cw = 6,    // right, top: must be rotated clockwise by 90 degrees
  transversed = 7,  // right, bottom
  turned_ccw = 8,   // left, bottom: must be rotated counterclockwise by 90 degrees
};

inline bool swaps_sides(Orientation o) { return o >= Orientation::transposed; }

/// Returns the upright picture. The top row comes first in memory in both.
Picture upright(Picture stored, Orientation orientation);

/// "turned by 90 degrees", for messages.
std::string name_of(Orientation orientation);

}  // namespace velour
