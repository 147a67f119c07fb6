// The orientation that cameras and editors store in a picture file (EXIF 2.3, tag 274).
#pragma once

#include <string>

#include "image/orientation.h"
#include "image/picture_format.h"

namespace velour {

/// Orientation stored in a JPEG (APP1 segment) or PNG file (eXIf chunk); normal if it is missing or invalid. Reads only
/// a few bytes of the file.
Orientation exif_orientation(PictureFormat format, const std::string& path);

/// Throws Error(bad_data) for a PNG file with a chunk that extends beyond the file: libraries allocate the stated size
/// of a chunk before they read it.
void check_png_chunks(const std::string& path);

}  // namespace velour
