// Marks in a square, in the order in which they are laid over each other: what both forms of a picture are made from.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "sphere/vec.h"

namespace velour {

/// Pixels from the upper left corner; y points down. Colours are sRGB, 0 to 1.
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
  Vec2 baseline;     // where the text starts, ends or has its middle
  float align;       // 0: starts there; 0.5: its middle; 1: ends there
  float size;        // em, pixels
  Rgb color;
};

struct Drawing {
  int side = 0;
  Rgb background{1};
  std::vector<std::variant<Stroke, Dot, Label>> marks;
};

}  // namespace velour
