// A drawing as pixels or as vector graphics.
#pragma once

#include <string>
#include <vector>
#include "plot/plot.h"

namespace velour {

/// RGBA, side x side, row 0 at the bottom; sRGB, 0 to 1, opaque. Edges are antialiased over one pixel.
std::vector<float> rasterized(const Drawing& drawing);

// A drawing as vector graphics.

/// SVG 1.1, side x side user units; text stays text, in DejaVu Sans if available.
std::string svg_text(const Drawing& drawing);

}  // namespace velour
