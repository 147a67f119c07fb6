// Data of a plot: series of numbers, axes with ranges and round ticks, without pixels.
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

// Ranges and ticks of axes, at round numbers.

struct PlotTick {
  double value;
  std::string text;
};

/// Text of at most four digits; k, M and G stand for 1e3, 1e6 and 1e9 from ten thousand on.
std::string tick_text(double value);

/// Sets the range from 0 to a round number that contains `largest`, which must be above 0.
void set_linear_range(PlotAxis& axis, double largest);
/// Sets a range between 1, 2 or 5 times powers of ten, at least a factor of two wide. Both must be above 0.
void set_logarithmic_range(PlotAxis& axis, double least, double largest);

/// Returns two to `most` ticks (`most` at least 3) in ascending order, all in the range: multiples of 1, 2 or 5 times a
/// power of ten; on a logarithmic axis powers of ten, or 1, 2 and 5 times them if those are few.
std::vector<PlotTick> ticks_of(const PlotAxis& axis, int most);

/// Position of `value`: 0 at the low end, 1 at the high end.
double place_on(const PlotAxis& axis, double value);

// The colors of a plot, kept readable in any theme.

/// Channels are sRGB as a display takes them, 0 to 1.
struct PlotColors {
  Rgb background{1, 1, 1};
  Rgb text{0.13f, 0.13f, 0.13f};
  Rgb model{0.0f, 0.45f, 0.7f};      // Okabe and Ito's blue and vermilion: safe for color blindness
  Rgb measured{0.84f, 0.37f, 0.0f};  // also the chosen point
  Rgb red{0.84f, 0.15f, 0.16f}, green{0.17f, 0.63f, 0.17f}, blue{0.12f, 0.38f, 0.85f};
};

/// Contrast (L1 + 0.05) / (L2 + 0.05) of relative luminances, 1 to 21 (WCAG 2.1).
float contrast(const Rgb& a, const Rgb& b);

/// Returns `colors` with a text contrast of at least 4.5 to the background, black or white if necessary, and all other
/// colors mixed with the text's as far as necessary for a contrast of 3.
PlotColors readable(const PlotColors& colors);

/// Color of marks; `colors` must come from readable().
Rgb color_of(PlotRole role, const PlotColors& colors);
/// Color of the grid lines.
Rgb grid_color(const PlotColors& colors);

}  // namespace velour
