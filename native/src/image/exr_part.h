// OpenEXR files that are a part of a larger picture, and say so.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "image/picture.h"

namespace velour {

/// Where pixels lie in a larger picture: its size, and the place of their lower left one, from its lower left corner.
struct PictureFrame {
  int width = 0, height = 0;
  int x = 0, y = 0;
  bool operator==(const PictureFrame&) const = default;
};

using PictureTexts = std::map<std::string, std::string>;  // by the attribute's name

/// What the header of the first part says.
struct ExrHeader {
  int width = 0, height = 0;          // of the pixels that are there (data window)
  std::vector<std::string> channels;  // as read_picture orders them
  PictureFrame frame;                 // they lie in the display window; where that is
  PictureTexts texts;
  bool multi_part = false;  // the file has further parts, which none of this is of
};

/// Throws Error with the file's name; Error(bad_data) for another format.
ExrHeader read_exr_header(const std::string& path);

/// As write_picture, with such a frame and texts. Throws Error(invalid_argument) where a name is one of OpenEXR's own.
void write_exr_part(const std::string& path, const Picture& picture, const PictureFrame& frame,
                    const PictureTexts& texts);

}  // namespace velour
