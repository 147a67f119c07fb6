// Data of a plot: series of numbers with their axes, without pixels.
#pragma once

#include <optional>
#include <string>
#include <vector>

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

}  // namespace velour
