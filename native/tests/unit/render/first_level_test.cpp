// How coarse the first picture of a change is.
#include "render/film/film.h"

#include <gtest/gtest.h>

namespace velour::first_level_test {
namespace {

int pixels(const FirstLevel& level, int width, int height) {
  const int divisor = level.divisor(level.first());
  return divided(width, divisor) * divided(height, divisor);
}

TEST(FirstLevel, LastHasThePicturesOwnPixels) {
  for (int width : {1, 37, 1156, 65536}) {
    const FirstLevel level(width, 852);
    EXPECT_EQ(level.divisor(level.last()), 1);
    EXPECT_LE(level.first(), level.last());
    EXPECT_LE(pixels(level, width, 852), 16000);
  }
}

TEST(FirstLevel, SmallPicturesBeginAtTheirOwnSize) {
  FirstLevel level(20, 30);
  EXPECT_EQ(level.first(), level.last());
  level.took(10);
  EXPECT_EQ(level.first(), level.last());
}

/// At each speed the finest one that is there in time, from wherever it begins, and no other after that.
TEST(FirstLevel, FitsTheMachine) {
  for (double pixels_per_second : {1e4, 1e5, 3e5, 1e6, 1e8}) {
    FirstLevel level(1156, 852);
    const auto seconds = [&] { return pixels(level, 1156, 852) / pixels_per_second; };
    for (double before : {1.0, 0.0}) {
      for (int n = 0; n < 10; ++n) level.took(before);
      for (int n = 0; n < 10; ++n) level.took(seconds());
      const int settled = level.first();
      level.took(seconds());
      EXPECT_EQ(level.first(), settled) << pixels_per_second;
      EXPECT_TRUE(seconds() <= 0.015 || settled == 0) << pixels_per_second;
      EXPECT_TRUE(8 * seconds() >= 0.015 || pixels(level, 1156, 852) > 4000) << pixels_per_second;
    }
  }
}

TEST(FirstLevel, WhatWasStoppedAtOnceTellsNothing) {
  FirstLevel level(1156, 852);
  level.took(1);
  const int coarser = level.first();
  level.took(0, false);
  EXPECT_EQ(level.first(), coarser);
  level.took(1, false);
  EXPECT_EQ(level.first(), coarser - 1);
}

}  // namespace
}  // namespace velour::first_level_test
