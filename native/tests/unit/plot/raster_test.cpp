#include "plot/output.h"

#include <gtest/gtest.h>

#include <cmath>

#include "plot/font.h"

namespace velour::raster_test {
namespace {

/// White marks on black: how much of the square they cover, in pixels.
double covered(const Drawing& drawing) {
  double sum = 0;
  const auto pixels = rasterized(drawing);
  for (size_t i = 0; i < pixels.size(); i += 4) sum += static_cast<double>(pixels[i]);
  return sum;
}

Drawing with(const std::variant<Stroke, Dot, Label>& mark) { return {64, Rgb(0), {mark}}; }

TEST(Raster, LinesAndDotsCoverWhatTheyAre) {
  // A line has round ends.
  const double ends = kPiD * 1.5 * 1.5;
  EXPECT_NEAR(covered(with(Stroke{{{10, 12.3f}, {50, 12.3f}}, 3, Rgb(1)})), 40 * 3 + ends, 3);
  const double slanted = std::hypot(40.0, 30.0);
  EXPECT_NEAR(covered(with(Stroke{{{10, 10}, {50, 40}}, 3, Rgb(1)})), slanted * 3 + ends, 4);
  EXPECT_NEAR(covered(with(Dot{{30.2f, 31.7f}, 8, Rgb(1)})), kPiD * 64, 3);
}

TEST(Raster, SegmentsThatMeetAreNotDrawnTwice) {
  std::vector<Vec2> points;
  for (int i = 0; i <= 400; ++i) points.emplace_back(10 + 0.1f * static_cast<float>(i), 30.5f);
  const double whole = covered(with(Stroke{{{10, 30.5f}, {50, 30.5f}}, 1, Rgb(1)}));
  EXPECT_NEAR(covered(with(Stroke{points, 1, Rgb(1)})), whole, 0.01 * whole);
}

TEST(Raster, RowZeroIsAtTheBottom) {
  const auto pixels = rasterized(with(Dot{{8.5f, 60.5f}, 1.5f, Rgb(0.2f, 0.4f, 0.6f)}));
  const float* pixel = pixels.data() + 4 * (3 * 64 + 8);
  EXPECT_FLOAT_EQ(pixel[0], 0.2f);
  EXPECT_FLOAT_EQ(pixel[1], 0.4f);
  EXPECT_FLOAT_EQ(pixel[2], 0.6f);
  EXPECT_FLOAT_EQ(pixel[3], 1);
}

TEST(Raster, WhatLiesOutsideIsLeftOut) {
  EXPECT_EQ(covered(with(Dot{{-20, 10}, 5, Rgb(1)})), 0);
  EXPECT_EQ(covered(with(Label{"far", {200, 30}, 0, 12, Rgb(1)})), 0);
  EXPECT_GT(covered(with(Label{"half", {60, 30}, 0, 12, Rgb(1)})), 0);
}

TEST(Raster, TextFillsItsWidthAndStandsOnItsBaseline) {
  const std::string text = "HIH";
  const auto pixels = rasterized(with(Label{text, {4, 40}, 0, 16, Rgb(1)}));
  int left = 64, right = 0, top = 64, bottom = 0;
  for (int row = 0; row < 64; ++row) {
    for (int x = 0; x < 64; ++x) {
      if (pixels[static_cast<size_t>(4 * (row * 64 + x))] < 0.5f) continue;
      left = std::min(left, x), right = std::max(right, x);
      top = std::min(top, 63 - row), bottom = std::max(bottom, 63 - row);
    }
  }
  EXPECT_GE(left, 4);
  EXPECT_LT(right, 4 + text_width(text, 16));
  EXPECT_GT(right, 4 + text_width(text, 16) - 4);
  EXPECT_EQ(bottom, 39) << "the last row above the baseline";
  EXPECT_NEAR(bottom - top + 1, 0.73 * 16, 1) << "capitals of DejaVu Sans";
}

TEST(Font, DigitsAreEquallyWideAndEveryCharacterIsThere) {
  for (char c = '1'; c <= '9'; ++c) EXPECT_EQ(text_width(std::string(1, c), 10), text_width("0", 10));
  EXPECT_NEAR(text_width("0", 2048), 1303, 0.01) << "DejaVu Sans says so";
  EXPECT_GT(text_width("W", 10), text_width("i", 10));
  // The box of what is not there has another width than these.
  const float missing = text_width("\u4e00", 100);
  for (const char* text : {"\u00b0", "\u03b8"}) EXPECT_NE(text_width(text, 100), missing) << text;
}

TEST(Svg, HoldsTheSameMarks) {
  const Drawing drawing{100,
                        Rgb(1),
                        {Stroke{{{1, 2}, {3.456f, 4}}, 1.5f, Rgb(0)}, Dot{{5, 6}, 2, Rgb(1, 0, 0)},
                         Label{"a<b & c", {7, 8}, 0.5f, 12, Rgb(0, 0, 1)}}};
  const std::string svg = svg_text(drawing);
  EXPECT_NE(svg.find("viewBox=\"0 0 100 100\""), std::string::npos);
  EXPECT_NE(svg.find("<polyline points=\"1,2 3.46,4\" stroke=\"#000000\" stroke-width=\"1.5\"/>"), std::string::npos);
  EXPECT_NE(svg.find("<circle cx=\"5\" cy=\"6\" r=\"2\" fill=\"#ff0000\"/>"), std::string::npos);
  EXPECT_NE(svg.find("text-anchor=\"middle\" fill=\"#0000ff\">a&lt;b &amp; c</text>"), std::string::npos);
}

}  // namespace
}  // namespace velour::raster_test
