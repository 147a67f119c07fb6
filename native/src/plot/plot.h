// Data of a plot: series of numbers with their axes, without pixels.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>
#include "math/sphere/vec.h"

namespace velour {

struct PlotPoint {
  double x, y;
};

/// Meaning of a series, which determines its color.
enum class PlotRole { model, lobe, measured, level, red, green, blue, text };
/// How a series is drawn.
enum class PlotMark { line, dashes, dots, line_and_dots };

struct PlotSeries {
  std::string name;
  PlotRole role = PlotRole::model;
  PlotMark mark = PlotMark::line;
  std::vector<PlotPoint> points = {};
  std::optional<size_t> chosen = std::nullopt;  // index of the model's own point
};

struct PlotAxis {
  std::string column;  // name of a table's column, with the unit
  std::string label;   // the same for a reader
  bool logarithmic = false;
  /// Visible range, low < high. On a logarithmic axis, values below `low` are drawn at `low`.
  double low = 0, high = 1;
};

struct PlotLegend {
  std::string text;
  PlotRole role;
  PlotMark mark;
};

struct Plot {
  std::string kind;
  /// x is then an angle in degrees from the normal, -90 to 90, positive towards the mirror direction; y the radius.
  bool polar = false;
  PlotAxis x = {}, y = {};
  std::vector<PlotSeries> series = {};  // in the order of drawing
  std::vector<PlotLegend> legend = {};  // drawn if it has more than one entry
};

// A plot as a table.

/// Lines "series,x,y,chosen" below the columns' names with their units; numbers have all digits.
std::string csv_text(const Plot& plot);

// Marks in a square, in drawing order: the input of both the raster and the SVG output.

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
