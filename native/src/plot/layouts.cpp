#include "plot/layouts.h"

#include <algorithm>
#include <cmath>
#include "plot/axes.h"

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

namespace {

struct HalfDisc {
  Vec2 center;
  float radius;
};

constexpr int kSpoke = 30;  // degrees between two spokes

std::string degrees_text(int degrees) { return std::to_string(std::abs(degrees)) + "\u00b0"; }

Vec2 on_circle(const HalfDisc& disc, float radius, double degrees) {
  const auto angle = static_cast<float>(radians_from(degrees));
  return disc.center + radius * Vec2(std::sin(angle), -std::cos(angle));
}

std::string radius_label(const Plot& plot) { return plot.y.label + (plot.y.logarithmic ? " (logarithmic)" : ""); }

/// Height of the text below the disk.
float height_below(const Plot& plot, const Pen& pen) {
  return 2 * pen.line_height() + 0.5f * pen.em() + pen.legend_height(plot, pen.side() - 2 * pen.margin());
}

HalfDisc disc_of(const Plot& plot, const Pen& pen) {
  const float half = 0.5f * pen.side() - pen.margin(), above = pen.line_height() + 0.2f * pen.em();
  const float below = height_below(plot, pen);
  const float at_sixty = (half - pen.width_of(degrees_text(60))) / std::sin(kPi / 3) - 0.4f * pen.em();
  const float under_rim = half - 0.5f * pen.width_of(tick_text(plot.y.high));
  const float radius = std::min({at_sixty, under_rim, 2 * half - above - below});
  const float spare = 2 * half - above - radius - below;
  return {{0.5f * pen.side(), pen.margin() + 0.5f * spare + above + radius}, radius};
}

void draw_rings(const Plot& plot, const HalfDisc& disc, Pen& pen) {
  const int most = std::clamp(static_cast<int>(disc.radius / (2.8f * pen.em())), 3, 6);
  float free_from = -1;
  for (const PlotTick& tick : ticks_of(plot.y, most)) {
    const float radius = disc.radius * static_cast<float>(place_on(plot.y, tick.value));
    std::vector<Vec2> ring;
    for (int a = -90; a <= 90; a += 2) ring.push_back(on_circle(disc, radius, a));
    if (radius > 0) pen.grid_line(ring);
    const float x = disc.center.x + radius, half = 0.5f * pen.width_of(tick.text);
    if (x - half < free_from) continue;
    free_from = x + half + 0.4f * pen.em();
    pen.text(tick.text, {x, disc.center.y + 1.1f * pen.em()}, 0.5f);
  }
}

void draw_spokes(const HalfDisc& disc, Pen& pen) {
  for (int a = -90; a <= 90; a += kSpoke) {
    pen.grid_line({disc.center, on_circle(disc, disc.radius, a)});
    if (std::abs(a) == 90) continue;
    const float align = a < 0 ? 1.0f : a > 0 ? 0.0f : 0.5f;
    const Vec2 at = on_circle(disc, disc.radius + 0.4f * pen.em(), a);
    pen.text(degrees_text(a), at + Vec2(0, a == 0 ? 0.0f : 0.2f * pen.em()), align);
  }
}

}  // namespace

void lay_out_polar(const Plot& plot, Pen& pen) {
  const HalfDisc disc = disc_of(plot, pen);
  draw_rings(plot, disc, pen);
  draw_spokes(disc, pen);
  for (const PlotSeries& series : plot.series) {
    std::vector<Vec2> points;
    for (const PlotPoint& p : series.points) {
      points.push_back(on_circle(disc, disc.radius * static_cast<float>(std::max(place_on(plot.y, p.y), 0.0)), p.x));
    }
    pen.series(series.role, series.mark, points, series.chosen);
  }
  const float label = disc.center.y + pen.line_height() + 1.1f * pen.em();
  pen.text(radius_label(plot), {disc.center.x, label}, 0.5f);
  const float legend = disc.center.y + 2 * pen.line_height() + 0.5f * pen.em();
  pen.legend(plot, {pen.margin(), legend}, pen.side() - 2 * pen.margin());
}

}  // namespace velour
