// The font of plots: a subset of DejaVu Sans embedded in the library.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace velour {

/// Width in pixels at `size` pixels per em. Missing glyphs are as wide as the font's empty box.
float text_width(std::string_view utf8, float size);

/// Coverage, 0 to 255, of a piece of text: `left` and `top` are pixels from where its baseline starts, y down.
struct TextPixels {
  int left = 0, top = 0, width = 0, height = 0;
  std::vector<uint8_t> coverage;  // row 0 at the top
};
/// The text starts `fraction` of a pixel, 0 to 1, right of a pixel's left edge; the baseline is between two rows.
TextPixels text_pixels(std::string_view utf8, float size, float fraction);

}  // namespace velour
