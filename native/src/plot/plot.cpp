#include "plot/plot.h"

#include <array>
#include <charconv>

namespace velour {
namespace {

/// The shortest text that reads back as the same number.
std::string exact(double value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

}  // namespace

std::string csv_text(const Plot& plot) {
  std::string out = "series," + plot.x.column + "," + plot.y.column + ",chosen\n";
  for (const PlotSeries& series : plot.series) {
    for (size_t i = 0; i < series.points.size(); ++i) {
      const PlotPoint& p = series.points[i];
      out += series.name + "," + exact(p.x) + "," + exact(p.y) + (series.chosen == i ? ",1\n" : ",0\n");
    }
  }
  return out;
}

}  // namespace velour
