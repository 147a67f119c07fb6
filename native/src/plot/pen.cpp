#include "plot/pen.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "plot/font.h"
#include "plot/plot.h"

namespace velour {

namespace {

// The two layouts of a plot.

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

/// x to the right, y upwards.
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

/// The upper half of a disk, with the surface's normal upwards; the radius is y.
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

constexpr float kMinText = 10, kSideOfText = 45, kLargestShare = 16;
constexpr float kTolerance = 0.05f;                                   // maximum error of a drawn line in pixels
constexpr float kSample = 1.8f, kSampleGap = 0.5f, kEntryGap = 1.2f;  // lengths in a legend, in em

float em_of(const PlotStyle& style) {
  const auto side = static_cast<float>(style.side);
  const float wanted = style.text > 0 ? style.text : std::max(kMinText, side / kSideOfText);
  return std::min(wanted, side / kLargestShare);
}

}  // namespace

Pen::Pen(const PlotStyle& style)
    : colors_(readable(style.colors)), em_(em_of(style)), drawing_{style.side, colors_.background, {}} {}

float Pen::width_of(const std::string& text) const { return text_width(text, em_); }

void Pen::text(const std::string& text, const Vec2& baseline, float align) {
  drawing_.marks.emplace_back(Label{text, baseline, align, em_, colors_.text});
}

void Pen::grid_line(const std::vector<Vec2>& points) {
  drawing_.marks.emplace_back(Stroke{points, std::max(1.0f, 0.07f * em_), grid_color(colors_)});
}

float Pen::line_width(PlotRole role) const {
  const float usual = std::max(1.2f, 0.15f * em_);
  return role == PlotRole::lobe || role == PlotRole::level ? 0.7f * usual : usual;
}

void Pen::dots(const std::vector<Vec2>& points, float radius, const Rgb& color) {
  for (const Vec2& p : points) drawing_.marks.emplace_back(Dot{p, radius, color});
}

void Pen::series(PlotRole role, PlotMark mark, const std::vector<Vec2>& points, std::optional<size_t> chosen) {
  const Rgb color = color_of(role, colors_);
  const float width = line_width(role);
  if (mark == PlotMark::dashes) {
    for (auto& piece : dashed(points, 0.5f * em_, 0.4f * em_)) {
      drawing_.marks.emplace_back(Stroke{std::move(piece), width, color});
    }
  } else if (mark != PlotMark::dots) {
    drawing_.marks.emplace_back(Stroke{simplified(points, kTolerance), width, color});
  }
  const float radius = std::max(1.3f, 0.16f * em_);
  if (mark == PlotMark::dots) dots(points, radius, color);
  if (mark == PlotMark::line_and_dots) dots(points, 1.4f * radius, color);
  if (chosen) dots({points.at(*chosen)}, 2.4f * radius, colors_.measured);
}

std::vector<Vec2> Pen::legend_places(const Plot& plot, float width) const {
  std::vector<Vec2> places;
  Vec2 at(0);
  for (const PlotLegend& entry : plot.legend) {
    const float own = (kSample + kSampleGap) * em_ + width_of(entry.text);
    if (at.x > 0 && at.x + own > width) at = {0, at.y + line_height()};
    places.push_back(at);
    at.x += own + kEntryGap * em_;
  }
  return places;
}

float Pen::legend_height(const Plot& plot, float width) const {
  return plot.legend.size() < 2 ? 0 : legend_places(plot, width).back().y + line_height();
}

void Pen::legend(const Plot& plot, const Vec2& upper_left, float width) {
  if (plot.legend.size() < 2) return;
  const std::vector<Vec2> places = legend_places(plot, width);
  for (size_t i = 0; i < places.size(); ++i) {
    const PlotLegend& entry = plot.legend[i];
    const Vec2 left = upper_left + places[i] + Vec2(0, 0.65f * em_);
    const Vec2 right = left + Vec2(kSample * em_, 0), middle = 0.5f * (left + right);
    if (entry.mark == PlotMark::dots) {
      series(entry.role, entry.mark, {middle});
    } else {
      series(entry.role, entry.mark, {left, right});
    }
    text(entry.text, {right.x + kSampleGap * em_, left.y + 0.35f * em_}, 0);
  }
}

namespace {

float distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 d = b - a;
  const float along = std::clamp(glm::dot(p - a, d) / std::max(glm::dot(d, d), 1e-12f), 0.0f, 1.0f);
  return glm::length(p - a - along * d);
}

}  // namespace

std::vector<Vec2> simplified(const std::vector<Vec2>& points, float tolerance) {
  if (points.size() < 3) return points;
  std::vector<uint8_t> kept(points.size());
  kept.front() = kept.back() = 1;
  std::vector<std::pair<size_t, size_t>> open{{0, points.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    float most = tolerance;
    size_t furthest = first;
    for (size_t i = first + 1; i < last; ++i) {
      const float away = distance_to_segment(points[i], points[first], points[last]);
      if (away > most) most = away, furthest = i;
    }
    if (furthest == first) continue;
    kept[furthest] = 1;
    open.emplace_back(first, furthest);
    open.emplace_back(furthest, last);
  }
  std::vector<Vec2> out;
  for (size_t i = 0; i < points.size(); ++i) {
    if (kept[i]) out.push_back(points[i]);
  }
  return out;
}

std::vector<std::vector<Vec2>> dashed(const std::vector<Vec2>& points, float on, float off) {
  std::vector<std::vector<Vec2>> pieces;
  if (points.empty()) return pieces;
  bool drawing = true;
  float left = on;
  pieces.push_back({points.front()});
  for (size_t i = 1; i < points.size(); ++i) {
    Vec2 at = points[i - 1];
    float rest = glm::length(points[i] - at);
    while (rest > left) {
      at += (points[i] - at) * (left / rest);
      rest -= left;
      drawing ? pieces.back().push_back(at) : pieces.push_back({at});
      drawing = !drawing;
      left = drawing ? on : off;
    }
    left -= rest;
    if (drawing) pieces.back().push_back(points[i]);
  }
  return pieces;
}

Drawing lay_out(const Plot& plot, const PlotStyle& style) {
  if (style.side < PlotStyle::kMinSide || style.side > PlotStyle::kLargestSide) {
    throw Error(Status::invalid_argument, "The size of the plot is " + std::to_string(style.side) +
                                              " pixels; it must be " + std::to_string(PlotStyle::kMinSide) + " to " +
                                              std::to_string(PlotStyle::kLargestSide) + ".");
  }
  if (!(style.text >= 0))
    throw Error(Status::invalid_argument, "The text size of the plot is negative; it must be at least 0.");
  Pen pen(style);
  plot.polar ? lay_out_polar(plot, pen) : lay_out_cartesian(plot, pen);
  return pen.take();
}

}  // namespace velour
