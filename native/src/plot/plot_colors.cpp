#include "plot/plot_colors.h"

#include <algorithm>

#include "image/srgb.h"

namespace velour {
namespace {

constexpr float kTextContrast = 4.5f, kMarkContrast = 3;  // WCAG 2.1, 1.4.3 and 1.4.11
constexpr int kSteps = 16;

float relative_luminance(const Rgb& c) {
  return luminance({linear_from_srgb(c.r), linear_from_srgb(c.g), linear_from_srgb(c.b)});
}

Rgb readable_text(const Rgb& text, const Rgb& background) {
  if (contrast(text, background) >= kTextContrast) return text;
  return contrast(Rgb(0), background) > contrast(Rgb(1), background) ? Rgb(0) : Rgb(1);
}

Rgb readable_mark(const Rgb& color, const PlotColors& colors) {
  for (int step = 0; step < kSteps; ++step) {
    const Rgb mixed = glm::mix(color, colors.text, static_cast<float>(step) / kSteps);
    if (contrast(mixed, colors.background) >= kMarkContrast) return mixed;
  }
  return colors.text;
}

}  // namespace

float contrast(const Rgb& a, const Rgb& b) {
  const auto [low, high] = std::minmax({relative_luminance(a), relative_luminance(b)});
  return (high + 0.05f) / (low + 0.05f);
}

PlotColors readable(const PlotColors& colors) {
  PlotColors out = colors;
  out.text = readable_text(colors.text, colors.background);
  for (Rgb PlotColors::*mark :
       {&PlotColors::model, &PlotColors::measured, &PlotColors::red, &PlotColors::green, &PlotColors::blue}) {
    out.*mark = readable_mark(colors.*mark, out);
  }
  return out;
}

Rgb color_of(PlotRole role, const PlotColors& colors) {
  switch (role) {
    case PlotRole::model:
      return colors.model;
    case PlotRole::lobe:
      return glm::mix(colors.background, colors.model, 0.72f);
    case PlotRole::measured:
      return colors.measured;
    case PlotRole::level:
      return glm::mix(colors.background, colors.text, 0.7f);
    case PlotRole::red:
      return colors.red;
    case PlotRole::green:
      return colors.green;
    case PlotRole::blue:
      return colors.blue;
    case PlotRole::text:
      break;
  }
  return colors.text;
}

Rgb grid_color(const PlotColors& colors) { return glm::mix(colors.background, colors.text, 0.18f); }

}  // namespace velour
