// What a plot shows: series of numbers with their axes. Nothing of pixels.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace velour {

struct PlotPoint {
  double x, y;
};

/// What a number is of: its colour.
enum class PlotRole { model, lobe, measured, level, red, green, blue, text };
/// How it is drawn.
enum class PlotMark { line, dashes, dots, line_and_dots };

struct PlotSeries {
  std::string name;
  PlotRole role = PlotRole::model;
  PlotMark mark = PlotMark::line;
  std::vector<PlotPoint> points = {};
  std::optional<size_t> chosen = std::nullopt;  // the point that the model is
};

struct PlotAxis {
  std::string column;  // with its unit, as a table names it
  std::string label;   // the same to a reader
  bool logarithmic = false;
  /// What is drawn, low < high. On a logarithmic axis less than `low` is drawn there.
  double low = 0, high = 1;
};

struct PlotLegend {
  std::string text;
  PlotRole role;
  PlotMark mark;
};

struct Plot {
  std::string kind;
  /// x is then an angle in degrees from the normal, -90 to 90, positive where the mirror direction is; y the radius.
  bool polar = false;
  PlotAxis x = {}, y = {};
  std::vector<PlotSeries> series = {};  // in the order of drawing
  std::vector<PlotLegend> legend = {};  // where there is more than one kind of series
};

}  // namespace velour
