#include <algorithm>
#include <cmath>

#include "plot/axes.h"
#include "plot/layouts.h"

namespace velour {
namespace {

/// The area inside the axes; y down.
struct PlotFrame {
  float left, top, right, bottom;
};

int tick_count(float length, float room) { return std::clamp(static_cast<int>(length / room), 3, 9); }

std::vector<PlotTick> ticks_upwards(const Plot& plot, const Pen& pen, float height) {
  return ticks_of(plot.y, tick_count(height, 2.2f * pen.em()));
}

/// The area that labels and legend leave.
PlotFrame frame_of(const Plot& plot, const Pen& pen) {
  const float side = pen.side(), margin = pen.margin(), line = pen.line_height();
  const float legend = pen.legend_height(plot, side - 2 * margin);
  PlotFrame frame{margin, margin + line + legend + 0.5f * pen.em(), side - margin, side - margin - 2 * line};
  for (const PlotTick& tick : ticks_upwards(plot, pen, frame.bottom - frame.top)) {
    frame.left = std::max(frame.left, margin + pen.width_of(tick.text) + 0.5f * pen.em());
  }
  // The last label of the x axis may be centered below the corner.
  frame.right -= 0.5f * pen.width_of(tick_text(plot.x.high));
  return frame;
}

Vec2 place(const Plot& plot, const PlotFrame& frame, const PlotPoint& p) {
  const auto x = static_cast<float>(place_on(plot.x, p.x)), y = static_cast<float>(place_on(plot.y, p.y));
  return {std::lerp(frame.left, frame.right, x), std::lerp(frame.bottom, frame.top, y)};
}

void draw_grid(const Plot& plot, const PlotFrame& frame, Pen& pen) {
  for (const PlotTick& tick : ticks_upwards(plot, pen, frame.bottom - frame.top)) {
    const float y = place(plot, frame, {plot.x.low, tick.value}).y;
    pen.grid_line({{frame.left, y}, {frame.right, y}});
    pen.text(tick.text, {frame.left - 0.5f * pen.em(), y + 0.36f * pen.em()}, 1);
  }
  float free_from = -1;
  for (const PlotTick& tick : ticks_of(plot.x, tick_count(frame.right - frame.left, 3.2f * pen.em()))) {
    const float x = place(plot, frame, {tick.value, plot.y.low}).x;
    pen.grid_line({{x, frame.top}, {x, frame.bottom}});
    const float half = 0.5f * pen.width_of(tick.text);
    if (x - half < free_from) continue;
    free_from = x + half + 0.4f * pen.em();
    pen.text(tick.text, {x, frame.bottom + 1.3f * pen.em()}, 0.5f);
  }
}

}  // namespace

void lay_out_cartesian(const Plot& plot, Pen& pen) {
  const PlotFrame frame = frame_of(plot, pen);
  const float margin = pen.margin(), first_baseline = margin + 0.9f * pen.em();
  pen.text(plot.y.label, {margin, first_baseline}, 0);
  pen.legend(plot, {margin, margin + pen.line_height()}, pen.side() - 2 * margin);
  draw_grid(plot, frame, pen);
  pen.text(plot.x.label, {0.5f * (frame.left + frame.right), pen.side() - margin - 0.2f * pen.em()}, 0.5f);
  for (const PlotSeries& series : plot.series) {
    std::vector<Vec2> points;
    for (const PlotPoint& p : series.points) points.push_back(place(plot, frame, p));
    pen.series(series.role, series.mark, points, series.chosen);
  }
}

}  // namespace velour
