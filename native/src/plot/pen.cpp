#include "plot/pen.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include "base/error.h"
#include "plot/font.h"
#include "plot/layouts.h"

namespace velour {

namespace {

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
