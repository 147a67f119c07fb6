#include "plot/font.h"

#include <algorithm>
#include <cmath>

#include "plot/font_bytes.h"

#define STBTT_STATIC
#define STB_TRUETYPE_IMPLEMENTATION
#include <stb/stb_truetype.h>

namespace velour {
namespace {

const stbtt_fontinfo& font() {
  static const stbtt_fontinfo kFont = [] {
    stbtt_fontinfo info;
    stbtt_InitFont(&info, kFontBytes.data(), 0);
    return info;
  }();
  return kFont;
}

/// Removes and returns the first code point; invalid UTF-8 is read byte by byte.
int take_code_point(std::string_view& utf8) {
  const auto byte = [&](size_t i) { return static_cast<int>(static_cast<unsigned char>(utf8[i])); };
  const int first = byte(0);
  const size_t size = first < 0xC0 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
  int code = first;
  if (size > 1 && size <= utf8.size()) {
    code = first & (0x7F >> size);
    for (size_t i = 1; i < size; ++i) code = code << 6 | (byte(i) & 0x3F);
  }
  utf8.remove_prefix(std::min(size, utf8.size()));
  return code;
}

/// Calls `visit(glyph, pen)` with the position of each glyph's origin; returns that of the next one.
template <typename Visit>
float lay_out(std::string_view utf8, float scale, const Visit& visit) {
  float pen = 0;
  while (!utf8.empty()) {
    const int glyph = stbtt_FindGlyphIndex(&font(), take_code_point(utf8));
    visit(glyph, pen);
    int advance = 0, bearing = 0;
    stbtt_GetGlyphHMetrics(&font(), glyph, &advance, &bearing);
    pen += scale * static_cast<float>(advance);
  }
  return pen;
}

float scale_of(float size) { return stbtt_ScaleForMappingEmToPixels(&font(), size); }

/// Composites `glyph` at `origin` onto `out`.
void add_glyph(int glyph, float scale, float origin, TextPixels& out) {
  const float whole = std::floor(origin), shift = origin - whole;
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  stbtt_GetGlyphBitmapBoxSubpixel(&font(), glyph, scale, scale, shift, 0, &x0, &y0, &x1, &y1);
  const int width = x1 - x0, height = y1 - y0;
  if (width <= 0 || height <= 0) return;
  std::vector<uint8_t> own(static_cast<size_t>(width) * static_cast<size_t>(height));
  stbtt_MakeGlyphBitmapSubpixel(&font(), own.data(), width, height, width, scale, scale, shift, 0, glyph);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int column = x0 + static_cast<int>(whole) + x - out.left, row = y0 + y - out.top;
      if (column < 0 || column >= out.width || row < 0 || row >= out.height) continue;
      uint8_t& pixel = out.coverage[static_cast<size_t>(row * out.width + column)];
      pixel = std::max(pixel, own[static_cast<size_t>(y * width + x)]);
    }
  }
}

}  // namespace

float text_width(std::string_view utf8, float size) {
  return lay_out(utf8, scale_of(size), [](int, float) {});
}

TextPixels text_pixels(std::string_view utf8, float size, float fraction) {
  const float scale = scale_of(size);
  const int room = static_cast<int>(std::ceil(size));  // margin for glyphs that extend beyond their advance
  TextPixels out{-room, -2 * room, 0, 3 * room, {}};
  out.width = static_cast<int>(std::ceil(text_width(utf8, size))) + 2 * room;
  out.coverage.resize(static_cast<size_t>(out.width) * static_cast<size_t>(out.height));
  lay_out(utf8, scale, [&](int glyph, float pen) { add_glyph(glyph, scale, pen + fraction, out); });
  return out;
}

}  // namespace velour
