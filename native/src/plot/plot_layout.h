// Lays out a plot in a square of pixels.
#pragma once

#include "plot/drawing.h"
#include "plot/plot.h"
#include "plot/plot_colors.h"

namespace velour {

struct PlotStyle {
  static constexpr int kLeastSide = 64, kLargestSide = 8192;
  int side = 800;  // pixels
  float text = 0;  // em of the text in pixels, at most a sixteenth of the side; 0: derived from the side
  PlotColors colors = {};
};

/// Throws Error(invalid_argument) for a side or text that is out of range.
Drawing lay_out(const Plot& plot, const PlotStyle& style);

}  // namespace velour
