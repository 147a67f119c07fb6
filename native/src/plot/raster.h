// A drawing as pixels.
#pragma once

#include <vector>

#include "plot/plot.h"

namespace velour {

/// RGBA, side x side, row 0 at the bottom; sRGB, 0 to 1, opaque. Edges are antialiased over one pixel.
std::vector<float> rasterized(const Drawing& drawing);

}  // namespace velour
