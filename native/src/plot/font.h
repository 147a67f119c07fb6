// The one font of plots: a part of DejaVu Sans that the library carries.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace velour {

/// Of `size` pixels an em. What the font lacks is as wide as its empty box.
float text_width(std::string_view utf8, float size);

/// Coverage, 0 to 255, of a piece of text: `left` and `top` are pixels from where its baseline starts, y down.
struct TextPixels {
  int left = 0, top = 0, width = 0, height = 0;
  std::vector<uint8_t> coverage;  // row 0 at the top
};
/// The text starts `fraction` of a pixel, 0 to 1, right of a pixel's left edge; the baseline is between two rows.
TextPixels text_pixels(std::string_view utf8, float size, float fraction);

}  // namespace velour
