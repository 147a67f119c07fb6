#include "plot/plot.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "image/picture.h"

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

namespace {

constexpr std::array<double, 3> kRound{1, 2, 5};
constexpr double kSlack = 1e-9;  // of a step, so that rounding excludes no tick

/// The smallest 1, 2 or 5 times a power of ten that is not below `value` > 0.
double round_up(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double m : kRound) {
    if (m * power >= value * (1 - kSlack)) return m * power;
  }
  return 10 * power;
}

double round_down(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value) + kSlack));
  for (auto m = kRound.rbegin(); m != kRound.rend(); ++m) {
    if (*m * power <= value * (1 + kSlack)) return *m * power;
  }
  return power;
}

PlotTick tick_at(double value) { return {value, tick_text(value)}; }

std::vector<PlotTick> linear_ticks(const PlotAxis& axis, int most) {
  double step = round_up((axis.high - axis.low) / most);
  const auto last = [&] { return static_cast<long>(std::floor(axis.high / step + kSlack)); };
  const auto first = [&] { return static_cast<long>(std::ceil(axis.low / step - kSlack)); };
  if (last() - first() >= most) step = round_up(1.5 * step);
  std::vector<PlotTick> ticks;
  for (long k = first(); k <= last(); ++k) ticks.push_back(tick_at(static_cast<double>(k) * step));
  return ticks;
}

/// Every `every`-th power of ten within the range, times `factors`.
template <typename Factors>
std::vector<PlotTick> powers_of_ten(const PlotAxis& axis, const Factors& factors, int every) {
  std::vector<PlotTick> ticks;
  const int last = static_cast<int>(std::floor(std::log10(axis.high) + kSlack));
  for (int power = static_cast<int>(std::floor(std::log10(axis.low) + kSlack)); power <= last; ++power) {
    if (power % every != 0) continue;
    for (const double m : factors) {
      const double value = m * std::pow(10.0, power);
      if (value >= axis.low * (1 - kSlack) && value <= axis.high * (1 + kSlack)) ticks.push_back(tick_at(value));
    }
  }
  return ticks;
}

std::vector<PlotTick> logarithmic_ticks(const PlotAxis& axis, int most) {
  const auto fit = [most](const std::vector<PlotTick>& ticks) {
    return ticks.size() >= 2 && ticks.size() <= static_cast<size_t>(most);
  };
  if (auto ticks = powers_of_ten(axis, kRound, 1); fit(ticks)) return ticks;
  for (int every = 1; every < 64; ++every) {
    if (auto ticks = powers_of_ten(axis, std::array<double, 1>{1}, every); fit(ticks)) return ticks;
  }
  return {tick_at(axis.low), tick_at(axis.high)};
}

}  // namespace

std::string tick_text(double value) {
  const char* suffix = "";
  for (const auto& [scale, name] : {std::pair(1e9, "G"), std::pair(1e6, "M"), std::pair(1e3, "k")}) {
    if (std::abs(value) < 1e4 || std::abs(value) < scale) continue;
    value /= scale;
    suffix = name;
    break;
  }
  std::array<char, 32> digits;
  std::snprintf(digits.data(), digits.size(), "%.4g", value);
  return std::string(digits.data()) + suffix;
}

void set_linear_range(PlotAxis& axis, double largest) {
  axis.logarithmic = false;
  axis.low = 0;
  // Up to the next of about ten steps, so that little of the plot stays empty.
  const double step = round_up(largest / 10);
  axis.high = step * std::ceil(largest / step - kSlack);
}

void set_logarithmic_range(PlotAxis& axis, double least, double largest) {
  axis.logarithmic = true;
  axis.low = round_down(least);
  axis.high = round_up(largest);
  if (axis.high < 2 * axis.low * (1 - kSlack)) axis.low = round_down(axis.low / 2), axis.high = round_up(axis.high * 2);
}

std::vector<PlotTick> ticks_of(const PlotAxis& axis, int most) {
  return axis.logarithmic ? logarithmic_ticks(axis, most) : linear_ticks(axis, most);
}

double place_on(const PlotAxis& axis, double value) {
  if (!axis.logarithmic) return (value - axis.low) / (axis.high - axis.low);
  return std::log(std::max(value, axis.low) / axis.low) / std::log(axis.high / axis.low);
}

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
