// A plot as a table.
#pragma once

#include <string>

#include "plot/plot.h"

namespace velour {

/// Lines "series,x,y,chosen", the names of x and y with their units; all digits of the numbers.
std::string csv_text(const Plot& plot);

}  // namespace velour
