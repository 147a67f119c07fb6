#include <algorithm>
#include <cmath>

#include "plot/axes.h"
#include "plot/layouts.h"

namespace velour {
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
