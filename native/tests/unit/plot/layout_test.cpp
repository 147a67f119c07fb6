#include "plot/pen.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "plot/font.h"
#include "plot/output.h"
#include "plot/plot.h"

namespace velour::layout_test {
namespace {

struct Box {
  float left, top, right, bottom;
};

/// From the capitals' height down to the baseline.
Box box_of(const Label& label) {
  const float width = text_width(label.text, label.size), left = label.baseline.x - label.align * width;
  return {left, label.baseline.y - 0.73f * label.size, left + width, label.baseline.y};
}

/// Closer than `gap` to each other.
bool overlap(const Box& a, const Box& b, float gap) {
  return a.left < b.right + gap && b.left < a.right + gap && a.top < b.bottom + gap && b.top < a.bottom + gap;
}

std::vector<Label> labels_of(const Drawing& drawing) {
  std::vector<Label> labels;
  for (const auto& mark : drawing.marks) {
    if (const auto* label = std::get_if<Label>(&mark)) labels.push_back(*label);
  }
  return labels;
}

Plot cartesian_plot(double least, double largest) {
  Plot plot{.kind = "order"};
  plot.x = {"lobes", "lobes"};
  plot.y = {"worst", "worst error / tolerance"};
  set_logarithmic_range(plot.x, 1, 32);
  set_logarithmic_range(plot.y, least, largest);
  plot.series.push_back({"error", PlotRole::model, PlotMark::line_and_dots, {{1, largest}, {32, least}}, 1});
  plot.legend = {{"error", PlotRole::model, PlotMark::line_and_dots}, {"tolerance", PlotRole::level, PlotMark::dashes}};
  return plot;
}

Plot polar_plot(double least, double largest) {
  Plot plot{.kind = "lobes", .polar = true};
  plot.x = {"theta_l_degrees", "light angle, degrees", false, -90, 90};
  plot.y = {"f_cos_per_sr", "f cos \u03b8, 1/sr"};
  set_logarithmic_range(plot.y, least, largest);
  plot.series.push_back({"model", PlotRole::model, PlotMark::line, {{-60, least}, {45, largest}}});
  plot.legend = {{"model", PlotRole::model, PlotMark::line},
                 {"lobes", PlotRole::lobe, PlotMark::line},
                 {"measured", PlotRole::measured, PlotMark::dots},
                 {"view at 30\u00b0", PlotRole::text, PlotMark::dashes}};
  return plot;
}

TEST(PlotLayout, TextsLieInsideAndApart) {
  for (const int side : {120, 160, 200, 283, 400, 1000, 2048}) {
    for (const float text : {0.0f, 10.0f, 11.0f, 15.0f, 22.0f}) {
      if (16 * text > static_cast<float>(side)) continue;
      for (const auto& [least, largest] : {std::pair(0.01, 0.04), std::pair(1e-4, 3.0), std::pair(20.0, 4e6)}) {
        for (const Plot& plot : {cartesian_plot(least, largest), polar_plot(least, largest)}) {
          const auto labels = labels_of(lay_out(plot, {.side = side, .text = text}));
          EXPECT_GE(labels.size(), 8u);
          for (size_t i = 0; i < labels.size(); ++i) {
            const Box box = box_of(labels[i]);
            EXPECT_TRUE(box.left >= 0 && box.top >= 0 && box.right <= static_cast<float>(side) &&
                        box.bottom <= static_cast<float>(side))
                << plot.kind << " " << side << " " << text << ": " << labels[i].text;
            for (size_t j = 0; j < i; ++j) {
              EXPECT_FALSE(overlap(box, box_of(labels[j]), 0.15f * labels[i].size))
                  << plot.kind << " " << side << " " << text << ": " << labels[i].text << " on " << labels[j].text;
            }
          }
        }
      }
    }
  }
}

/// Where the ticks of an axis put `value`, from two labels' places: x of the lobes, y of the errors.
TEST(PlotLayout, PointsLieWhereTheTicksSay) {
  const Plot plot = cartesian_plot(0.1, 10);
  const Drawing drawing = lay_out(plot, {.side = 400});
  Vec2 one(0), ten(0);
  for (const Label& label : labels_of(drawing)) {
    const Box box = box_of(label);
    const bool below = label.align == 0.5f;
    if (label.text == "1") (below ? one.x : one.y) = below ? label.baseline.x : box.bottom;
    if (label.text == "10") (below ? ten.x : ten.y) = below ? label.baseline.x : box.bottom;
  }
  std::vector<Dot> dots;
  for (const auto& mark : drawing.marks) {
    if (const auto* dot = std::get_if<Dot>(&mark)) dots.push_back(*dot);
  }
  const Dot& chosen = dots.back();  // 32 lobes, error 0.1
  EXPECT_NEAR(chosen.center.x, one.x + std::log10(32.0f) * (ten.x - one.x), 0.5);
  // Labels stand a little below their line, all of them alike.
  EXPECT_NEAR(chosen.center.y - dots[dots.size() - 3].center.y, 2 * (one.y - ten.y), 0.5);
  const auto pixels = rasterized(drawing);
  const auto row = static_cast<size_t>(399 - chosen.center.y), column = static_cast<size_t>(chosen.center.x);
  EXPECT_NEAR(pixels[4 * (row * 400 + column)], PlotColors().measured.r, 1e-3);
}

/// What the caption says: the viewer on the left, what it mirrors on the right.
TEST(PlotLayout, PositiveAnglesLieOnTheRightOfAHalfDisc) {
  Plot plot = polar_plot(0.01, 1);
  plot.series = {{"measured", PlotRole::measured, PlotMark::dots, {{-60, 1}, {30, 1}}}};
  std::vector<Dot> dots;
  for (const auto& mark : lay_out(plot, {.side = 400}).marks) {
    if (const auto* dot = std::get_if<Dot>(&mark)) dots.push_back(*dot);
  }
  ASSERT_GE(dots.size(), 2u);
  EXPECT_LT(dots[0].center.x, 200 - 50);
  EXPECT_GT(dots[1].center.x, 200 + 25);
  EXPECT_LT(dots[1].center.y, dots[0].center.y);  // the normal is up
}

TEST(PlotLayout, SidesOutOfRangeAreRefused) {
  for (const int side : {0, 63, 8193}) EXPECT_THROW(lay_out(cartesian_plot(0.1, 1), {.side = side}), Error);
  EXPECT_THROW(lay_out(cartesian_plot(0.1, 1), {.side = 100, .text = -1}), Error);
}

}  // namespace
}  // namespace velour::layout_test
