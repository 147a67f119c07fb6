// A drawing as pixels.
#pragma once

#include <vector>

#include "plot/drawing.h"

namespace velour {

/// RGBA, side x side, row 0 at the bottom; sRGB, 0 to 1, opaque. Edges are smooth over a pixel.
std::vector<float> rasterized(const Drawing& drawing);

}  // namespace velour
