#include "btf/measure/pair_layout.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include "base/error.h"
#include "support/test_data.h"
#include "support/warnings.h"

namespace velour::pair_layout_test {
namespace {

TEST(PolarAngles, GiveUnitVectorsThatAreExactOnTheAxes) {
  EXPECT_EQ(unit_direction({0, 0}), Vec3(0, 0, 1));
  EXPECT_EQ(unit_direction({180, 77}), Vec3(0, 0, -1));
  EXPECT_EQ(unit_direction({90, 90}), Vec3(0, 1, 0));
  EXPECT_EQ(unit_direction({90, 180}), Vec3(-1, 0, 0));
  EXPECT_EQ(unit_direction({30, 45}), unit_direction({30, 405}));
  for (const PolarAngles& d : even_directions(300)) EXPECT_NEAR(glm::length(unit_direction(d)), 1.0f, 1e-6f);
}

TEST(PolarAngles, TheBonnSetHasItsRings) {
  const std::vector<PolarAngles> set = bonn_directions();
  ASSERT_EQ(set.size(), 81u);
  EXPECT_EQ(set[7], (PolarAngles{30, 0}));
  EXPECT_EQ(set[8], (PolarAngles{30, 30}));
  EXPECT_EQ(set.back(), (PolarAngles{75, 345}));
}

TEST(PolarAngles, TheBonnSetIsThePublishedOne) {
  VELOUR_NEED_DATA(path, "btf/ubo2003_directions.csv");
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);  // the head
  for (const PolarAngles& expected : bonn_directions()) {
    ASSERT_TRUE(std::getline(file, line));
    EXPECT_EQ(line, std::to_string(std::lround(expected.theta)) + "," + std::to_string(std::lround(expected.phi)));
  }
}

TEST(PolarAngles, EvenDirectionsComeBackAsTheVectorsTheyWere) {
  for (const PolarAngles& d : below(even_directions(50))) EXPECT_LT(unit_direction(d).z, 0);
  for (const PolarAngles& d : even_directions(50)) EXPECT_GE(d.phi, 0);
}

TEST(PairLayout, NumbersPairsByViewThenLight) {
  const PairLayout layout(bonn_directions(), ring_directions(40, 5));
  EXPECT_TRUE(layout.complete());
  EXPECT_EQ(layout.pairs(), 405u);
  EXPECT_EQ(layout.first(3), 15u);
  EXPECT_EQ(layout.view_of(14), 2u);
  EXPECT_EQ(layout.view_of(15), 3u);
  EXPECT_EQ(layout.light_of(16), 1u);
  EXPECT_EQ(layout.directions(16).wv, unit_direction(bonn_directions()[3]));
}

TEST(PairLayout, HoldsViewsWithLightsOfTheirOwn) {
  const PairLayout layout(ring_directions(20, 3), ring_directions(40, 4), {{0, 2}, {}, {1, 2, 3}});
  EXPECT_FALSE(layout.complete());
  EXPECT_EQ(layout.pairs(), 5u);
  EXPECT_EQ(layout.view_of(1), 0u);
  EXPECT_EQ(layout.view_of(2), 2u);
  EXPECT_EQ(layout.light_of(4), 3u);
}

TEST(PairLayout, TellsOfDirectionsThatAreThereTwice) {
  EXPECT_FALSE(repeated_directions({capture_directions(), even_directions(250)}));
  EXPECT_FALSE(repeated_directions({{{30, 0}, {30, 0.01}}, below({{30, 0}, {30.01, 0}})}));
  const std::vector<PolarAngles> pole{{0, 0}, {0, 90}, {0, 180}, {30, 7}},
      seam{{40, 0}, {40, 360}, {50, -30}, {50, 330}};
  const auto repeated = [](uint64_t views, uint64_t lights) {
    return warning<WarningCode::repeated_directions>({{"views", views}, {"lights", lights}});
  };
  EXPECT_EQ(repeated_directions({pole, {{10, 0}}}), repeated(2, 0));
  EXPECT_EQ(repeated_directions({{{10, 0}}, seam}), repeated(0, 2));
}

TEST(PairLayout, RefusesWhatIsNoLayout) {
  const std::vector<PolarAngles> good = ring_directions(20, 3);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(PairLayout({}, good), Error);
  EXPECT_THROW(PairLayout(good, {{10, 0}, {10, 0}}), Error);
  EXPECT_THROW(PairLayout(good, {{90, 0}}), Error);
  EXPECT_THROW(PairLayout(good, {{nan, 0}}), Error);
  EXPECT_THROW(PairLayout(good, {{10, nan}}), Error);
  EXPECT_THROW(PairLayout(good, {{190, 0}}), Error);
  EXPECT_THROW(PairLayout(good, good, {{0}, {1}}), Error);         // a view too few
  EXPECT_THROW(PairLayout(good, good, {{0}, {1}, {3}}), Error);    // no light 3
  EXPECT_THROW(PairLayout(good, good, {{0}, {1, 1}, {}}), Error);  // twice
  EXPECT_THROW(PairLayout(good, good, {{}, {}, {}}), Error);       // no pair at all
}

}  // namespace
}  // namespace velour::pair_layout_test
