#include "plot/plot_layout.h"

#include "job/error.h"
#include "plot/layouts.h"

namespace velour {

Drawing lay_out(const Plot& plot, const PlotStyle& style) {
  if (style.side < PlotStyle::kLeastSide || style.side > PlotStyle::kLargestSide) {
    throw Error(Status::invalid_argument, "The size of the plot is " + std::to_string(style.side) +
                                              " pixels; it must be " + std::to_string(PlotStyle::kLeastSide) + " to " +
                                              std::to_string(PlotStyle::kLargestSide) + ".");
  }
  if (!(style.text >= 0))
    throw Error(Status::invalid_argument, "The text size of the plot is negative; it must be at least 0.");
  Pen pen(style);
  plot.polar ? lay_out_polar(plot, pen) : lay_out_cartesian(plot, pen);
  return pen.take();
}

}  // namespace velour
