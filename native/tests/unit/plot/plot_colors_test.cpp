#include "plot/plot.h"

#include <gtest/gtest.h>

namespace velour::plot_colors_test {
namespace {

TEST(PlotColors, ContrastIsThatOfTheGuidelines) {
  EXPECT_NEAR(contrast(Rgb(0), Rgb(1)), 21, 1e-3);
  EXPECT_NEAR(contrast(Rgb(1), Rgb(0.5f, 0.5f, 0.5f)), 3.98, 0.02);
  EXPECT_EQ(contrast(Rgb(0.3f), Rgb(0.3f)), 1);
}

TEST(PlotColors, EverythingIsReadableOnAnyBackground) {
  for (float gray = 0; gray <= 1; gray += 0.05f) {
    PlotColors theme;
    theme.background = {gray, 0.9f * gray, 0.5f + 0.5f * gray};
    theme.text = Rgb(0.5f);
    const PlotColors out = readable(theme);
    EXPECT_GE(contrast(out.text, out.background), 4.5f) << gray;
    for (const Rgb& mark : {out.model, out.measured, out.red, out.green, out.blue}) {
      EXPECT_GE(contrast(mark, out.background), 3) << gray;
    }
  }
}

TEST(PlotColors, WhatIsReadableStaysAsItIs) {
  const PlotColors paper;
  const PlotColors out = readable(paper);
  EXPECT_EQ(out.text, paper.text);
  EXPECT_EQ(out.model, paper.model);
  EXPECT_EQ(out.measured, paper.measured);
  PlotColors dark = paper;
  dark.background = Rgb(0.25f);
  dark.text = Rgb(0.9f);
  EXPECT_NE(readable(dark).blue, dark.blue) << "the blue of paper is too dark there";
}

}  // namespace
}  // namespace velour::plot_colors_test
