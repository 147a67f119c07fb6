// A plot as a table.
#pragma once

#include <string>

#include "plot/plot.h"

namespace velour {

/// Lines "series,x,y,chosen" below the columns' names with their units; numbers have all digits.
std::string csv_text(const Plot& plot);

}  // namespace velour
