// Orientation of a picture's stored rows and columns in the upright picture.
#pragma once

#include <string>
#include "image/picture.h"
#include "image/picture_format.h"

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

// The orientation that cameras and editors store in a picture file (EXIF 2.3, tag 274).

/// Orientation stored in a JPEG (APP1 segment) or PNG file (eXIf chunk); normal if it is missing or invalid. Reads only
/// a few bytes of the file.
Orientation exif_orientation(PictureFormat format, const std::string& path);

/// Throws Error(bad_data) for a PNG file with a chunk that extends beyond the file: libraries allocate the stated size
/// of a chunk before they read it.
void check_png_chunks(const std::string& path);

}  // namespace velour
