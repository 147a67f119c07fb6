// Draws the parts that all plots share, in the plot's colors, with widths that scale with its text.
#pragma once

#include <optional>
#include <string>
#include <vector>
#include "math/sphere/vec.h"
#include "plot/plot.h"

namespace velour {

// Lays out a plot in a square of pixels.

struct PlotStyle {
  static constexpr int kMinSide = 64, kLargestSide = 8192;
  int side = 800;  // pixels
  float text = 0;  // em of the text in pixels, at most a sixteenth of the side; 0: derived from the side
  PlotColors colors = {};
};

/// Throws Error(invalid_argument) for a side or text that is out of range.
Drawing lay_out(const Plot& plot, const PlotStyle& style);

class Pen {
 public:
  explicit Pen(const PlotStyle& style);

  float side() const { return static_cast<float>(drawing_.side); }
  float em() const { return em_; }
  float line_height() const { return 1.35f * em_; }
  float margin() const { return 0.6f * em_; }  // of the square
  float width_of(const std::string& text) const;

  void text(const std::string& text, const Vec2& baseline, float align);
  void grid_line(const std::vector<Vec2>& points);
  void series(PlotRole role, PlotMark mark, const std::vector<Vec2>& points,
              std::optional<size_t> chosen = std::nullopt);

  /// Height of the legend of `plot`, in lines of at most `width`.
  float legend_height(const Plot& plot, float width) const;
  void legend(const Plot& plot, const Vec2& upper_left, float width);

  Drawing take() { return std::move(drawing_); }

 private:
  std::vector<Vec2> legend_places(const Plot& plot, float width) const;
  void dots(const std::vector<Vec2>& points, float radius, const Rgb& color);
  float line_width(PlotRole role) const;

  PlotColors colors_;
  float em_;
  Drawing drawing_;
};

// Simplification and dashing of polylines.

/// A subset of `points`, including the first and the last, whose line is within `tolerance` of all omitted points
/// [DP73].
std::vector<Vec2> simplified(const std::vector<Vec2>& points, float tolerance);

/// Pieces of the line, `on` long, with gaps of `off` between them.
std::vector<std::vector<Vec2>> dashed(const std::vector<Vec2>& points, float on, float off);

}  // namespace velour
