// A drawing as vector graphics.
#pragma once

#include <string>

#include "plot/plot.h"

namespace velour {

/// SVG 1.1, side x side user units; text stays text, in DejaVu Sans if available.
std::string svg_text(const Drawing& drawing);

}  // namespace velour
