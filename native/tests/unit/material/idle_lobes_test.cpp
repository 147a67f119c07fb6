#include "brdf/eval/parametric_table.h"

#include <gtest/gtest.h>

#include <cmath>

#include "math/srbf/warped_lobe.h"

namespace velour::idle_lobes_test {
namespace {

const Vec3d kView(std::sin(0.7), 0, std::cos(0.7));

/// In the order of their arrays.
WarpedMixture mixture(const std::vector<WarpedLobe>& lobes) {
  WarpedMixture m;
  m.count = static_cast<int>(lobes.size());
  m.padded = WarpedMixture::padded_of(m.count);
  for (int j = 0; j < m.padded; ++j) {
    const WarpedLobe l = j < m.count ? lobes[static_cast<size_t>(j)] : WarpedLobe{};
    m.half[j] = l.space == LobeSpace::half ? 1.0f : 0.0f;
    m.s_xx[j] = m.s_yy[j] = 1;
    m.s_xy[j] = m.x[j] = m.y[j] = 0;
    m.z[j] = 1;
    m.bandwidth[j] = static_cast<float>(l.bandwidth);
    m.r[j] = static_cast<float>(l.coefficient.x);
    m.g[j] = static_cast<float>(l.coefficient.y);
    m.b[j] = static_cast<float>(l.coefficient.z);
  }
  m.wv = Vec3(kView);
  return m;
}

WarpedLobe lobe(double bandwidth, double coefficient, LobeSpace space = LobeSpace::light) {
  return {space, {}, {0, 0, 1}, bandwidth, Vec3d(coefficient)};
}

uint32_t matter(const std::vector<WarpedLobe>& lobes) {
  const WarpedMixture m = mixture(lobes);
  return lobes_that_matter(m, LightPoints(m));
}

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
}  // namespace velour::idle_lobes_test
