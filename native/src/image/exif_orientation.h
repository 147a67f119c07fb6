// The orientation that cameras and editors write beside the pixels (EXIF 2.3, tag 274).
#pragma once

#include <string>

#include "image/orientation.h"
#include "image/picture_format.h"

namespace velour {

/// From a JPEG (APP1 segment) or a PNG (eXIf chunk); normal where the file says nothing, or
/// nothing that makes sense. Reads a few bytes of the file.
Orientation exif_orientation(PictureFormat format, const std::string& path);

/// Throws Error(bad_data) for a PNG file with a chunk that does not lie within the file: libraries take memory for what
/// a chunk says that it holds before they read it.
void check_png_chunks(const std::string& path);

}  // namespace velour
