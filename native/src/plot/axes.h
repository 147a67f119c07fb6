// Ranges and ticks of axes, at round numbers.
#pragma once

#include <string>
#include <vector>

#include "plot/plot.h"

namespace velour {

struct PlotTick {
  double value;
  std::string text;
};

/// Text of at most four digits; k, M and G stand for 1e3, 1e6 and 1e9 from ten thousand on.
std::string tick_text(double value);

/// Sets the range from 0 to a round number that contains `largest`, which must be above 0.
void set_linear_range(PlotAxis& axis, double largest);
/// Sets a range between 1, 2 or 5 times powers of ten, at least a factor of two wide. Both must be above 0.
void set_logarithmic_range(PlotAxis& axis, double least, double largest);

/// Returns two to `most` ticks (`most` at least 3) in ascending order, all in the range: multiples of 1, 2 or 5 times a
/// power of ten; on a logarithmic axis powers of ten, or 1, 2 and 5 times them if those are few.
std::vector<PlotTick> ticks_of(const PlotAxis& axis, int most);

/// Position of `value`: 0 at the low end, 1 at the high end.
double place_on(const PlotAxis& axis, double value);

}  // namespace velour
