// Ranges and ticks of axes that a reader can calculate with.
#pragma once

#include <string>
#include <vector>

#include "plot/plot.h"

namespace velour {

struct PlotTick {
  double value;
  std::string text;
};

/// At most four digits; k, M and G stand for 1e3, 1e6 and 1e9 from ten thousand on.
std::string tick_text(double value);

/// The range from 0 to a round number that holds `largest`, which is above 0.
void set_linear_range(PlotAxis& axis, double largest);
/// Between 1, 2 or 5 times powers of ten; at least a factor of two. Both above 0.
void set_logarithmic_range(PlotAxis& axis, double least, double largest);

/// Between two and `most` ticks, at least 3, in rising order, all in the range: multiples of 1, 2 or 5 times a power of
/// ten; on a logarithmic axis powers of ten, or 1, 2 and 5 times them where these are few.
std::vector<PlotTick> ticks_of(const PlotAxis& axis, int most);

/// Where `value` lies: 0 at the low end, 1 at the high one.
double place_on(const PlotAxis& axis, double value);

}  // namespace velour
