// Reads PNG and JPEG files in a library without OpenImageIO, which would bring some 260 others, using libraries
// linked into it. Values, channels and refusals match OpenImageIO's (portable_picture_test.cpp). Internal to image/.
#pragma once

#include <memory>
#include <string>

#include "image/open_picture.h"

namespace velour {

/// Opens PNG files with stb_image.
std::unique_ptr<OpenPicture> open_by_stb(const std::string& path);
/// Opens JPEG files with libjpeg; CMYK becomes RGB.
std::unique_ptr<OpenPicture> open_jpeg(const std::string& path);

}  // namespace velour
