// Pictures of integers in a library without OpenImageIO, which would bring some 260 others: by libraries that are
// linked into it. Values, channels and refusals are OpenImageIO's (portable_picture_test.cpp). Internal to image/.
#pragma once

#include <memory>
#include <string>

#include "image/open_picture.h"

namespace velour {

/// PNG and BMP, by stb_image.
std::unique_ptr<OpenPicture> open_by_stb(const std::string& path, PictureFormat format);
/// By libjpeg; CMYK becomes RGB.
std::unique_ptr<OpenPicture> open_jpeg(const std::string& path);

}  // namespace velour
