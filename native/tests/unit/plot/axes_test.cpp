#include "plot/plot.h"

#include <gtest/gtest.h>

#include <cmath>

namespace velour::axes_test {
namespace {

std::vector<std::string> texts(const PlotAxis& axis, int most) {
  std::vector<std::string> out;
  for (const PlotTick& tick : ticks_of(axis, most)) out.push_back(tick.text);
  return out;
}

using Texts = std::vector<std::string>;

TEST(Axes, TicksAreThoseThatAReaderExpects) {
  PlotAxis axis{.column = "x", .label = "x"};
  set_linear_range(axis, 0.83);
  EXPECT_EQ(texts(axis, 6), (Texts{"0", "0.2", "0.4", "0.6", "0.8"}));
  set_logarithmic_range(axis, 0.013, 0.07);
  EXPECT_EQ(texts(axis, 6), (Texts{"0.01", "0.02", "0.05", "0.1"}));
  set_logarithmic_range(axis, 3e-4, 900);
  EXPECT_EQ(texts(axis, 8), (Texts{"0.001", "0.01", "0.1", "1", "10", "100", "1000"}));
  set_logarithmic_range(axis, 52, 2e6);
  EXPECT_EQ(texts(axis, 5), (Texts{"100", "1000", "10k", "100k", "1M"}));
}

TEST(Axes, EveryRangeHasRoundTicksInsideIt) {
  for (double largest = 1e-6; largest < 1e8; largest *= 1.37) {
    for (const double ratio : {1.0, 1.01, 3.0, 40.0, 1e5}) {
      for (const int most : {3, 4, 7, 9}) {
        PlotAxis axis{.column = "x", .label = "x"};
        ratio == 1.0 ? set_linear_range(axis, largest) : set_logarithmic_range(axis, largest / ratio, largest);
        EXPECT_LE(axis.low, largest / ratio * (1 + 1e-9));
        EXPECT_GE(axis.high, largest * (1 - 1e-9));
        const auto ticks = ticks_of(axis, most);
        ASSERT_GE(ticks.size(), 2u) << largest << " " << ratio << " " << most;
        ASSERT_LE(ticks.size(), static_cast<size_t>(most)) << largest << " " << ratio;
        for (size_t i = 0; i < ticks.size(); ++i) {
          EXPECT_GE(place_on(axis, ticks[i].value), -1e-9);
          EXPECT_LE(place_on(axis, ticks[i].value), 1 + 1e-9);
          if (i > 0) {
            EXPECT_GT(ticks[i].value, ticks[i - 1].value);
          }
        }
      }
    }
  }
}

TEST(Axes, ALinearRangeLeavesLittleEmpty) {
  for (double largest = 0.011; largest < 1000; largest *= 1.21) {
    PlotAxis axis{.column = "x", .label = "x"};
    set_linear_range(axis, largest);
    EXPECT_LT(axis.high, 1.21 * largest) << largest;
  }
}

TEST(Axes, PlacesAreLinearOrLogarithmic) {
  const PlotAxis linear{.column = "x", .label = "x", .low = 0, .high = 90};
  EXPECT_DOUBLE_EQ(place_on(linear, 30), 1.0 / 3);
  const PlotAxis logarithmic{.column = "x", .label = "x", .logarithmic = true, .low = 0.01, .high = 100};
  EXPECT_NEAR(place_on(logarithmic, 1), 0.5, 1e-12);
  EXPECT_EQ(place_on(logarithmic, 0), 0) << "what is black is drawn at the low end";
  EXPECT_EQ(place_on(logarithmic, -3), 0);
}

}  // namespace
}  // namespace velour::axes_test
