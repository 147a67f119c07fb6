#include "material/idle_lobes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace velour {
namespace {

const Vec3d kView(std::sin(0.7), 0, std::cos(0.7));

WarpedLobe lobe(double bandwidth, double coefficient, LobeSpace space = LobeSpace::light) {
  return {space, {}, {0, 0, 1}, bandwidth, Vec3d(coefficient)};
}

uint32_t matter(const std::vector<WarpedLobe>& lobes) { return lobes_that_matter(lobes, LightPoints(lobes, kView)); }

TEST(IdleLobes, ALobeThatHardlyShowsIsLeftOut) {
  EXPECT_EQ(matter({lobe(1, 0.3), lobe(2, 1e-4)}), 0b01u);
  EXPECT_EQ(matter({lobe(1, 0.3), lobe(2, 1e-3)}), 0b11u);
}

// A highlight with a millionth of the albedo and twice the value of what lies under it; and one with a fiftieth.
TEST(IdleLobes, ANarrowPeakStays) {
  EXPECT_EQ(matter({lobe(0.1, 0.3), lobe(1e6, 0.6, LobeSpace::half)}), 0b11u);
  EXPECT_EQ(matter({lobe(0.1, 0.3), lobe(1e6, 0.012, LobeSpace::half)}), 0b11u);
}

// Faint beside the highlight, but all there is elsewhere.
TEST(IdleLobes, TheBaseUnderAStrongHighlightStays) {
  EXPECT_EQ(matter({lobe(1e5, 1e5, LobeSpace::half), lobe(0.01, 1e-4)}), 0b11u);
}

TEST(IdleLobes, ManyTogetherCountTogether) {
  std::vector<WarpedLobe> lobes(20, lobe(1, 6e-5));
  lobes[7] = lobe(1, 0.3);
  const uint32_t found = matter(lobes);
  EXPECT_TRUE(found >> 7 & 1);
  EXPECT_EQ(__builtin_popcount(found), 15);  // of 2e-4 each five are left out
}

TEST(IdleLobes, BlueIsNoLessThanGreen) {
  WarpedLobe blue = lobe(2, 0);
  blue.coefficient.z = 1e-3;  // a fourteenth of it in luminance
  EXPECT_EQ(matter({lobe(1, 0.3), blue}), 0b11u);
}

TEST(IdleLobes, WithoutLightAllStay) {
  EXPECT_EQ(matter({lobe(1, 0), lobe(1, 0)}), 0b11u);
  EXPECT_EQ(matter({}), 0u);
}

}  // namespace
}  // namespace velour
