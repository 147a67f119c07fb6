// The colors of a plot, kept readable in any theme.
#pragma once

#include "plot/plot.h"
#include "sphere/vec.h"

namespace velour {

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
