// Marks in a square, in drawing order: the input of both the raster and the SVG output.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "sphere/vec.h"

namespace velour {

/// Pixels from the upper left corner; y points down. Colors are sRGB, 0 to 1.
struct Stroke {
  std::vector<Vec2> points;
  float width;
  Rgb color;
};

struct Dot {
  Vec2 center;
  float radius;
  Rgb color;
};

struct Label {
  std::string text;  // UTF-8
  Vec2 baseline;     // start, middle or end of the text, by `align`
  float align;       // 0: the text starts at `baseline`; 0.5: is centered; 1: ends
  float size;        // em, pixels
  Rgb color;
};

struct Drawing {
  int side = 0;
  Rgb background{1};
  std::vector<std::variant<Stroke, Dot, Label>> marks;
};

}  // namespace velour
