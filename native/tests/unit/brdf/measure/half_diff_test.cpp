#include "brdf/measure/brdf_table.h"

#include <gtest/gtest.h>

#include <cmath>

#include "measurement_support.h"

namespace velour::half_diff_test {
namespace {

TEST(FastAtan2, WithinItsStatedError) {
  double worst = 0;
  for (int i = 0; i < 100000; ++i) {
    const double angle = (i / 100000.0 * 2 - 1) * kPiD, length = std::pow(10.0, i % 13 - 6);
    const auto y = static_cast<float>(length * std::sin(angle)), x = static_cast<float>(length * std::cos(angle));
    worst = std::max(worst, std::abs(static_cast<double>(fast_atan2(y, x)) - std::atan2(double{y}, double{x})));
  }
  EXPECT_LT(worst, 4e-7);  // 3e-7, and half a unit in the last place of pi
  EXPECT_EQ(fast_atan2(0, 0), 0.0f);
  EXPECT_EQ(fast_atan2(0, 1), 0.0f);
  EXPECT_FLOAT_EQ(fast_atan2(1, 0), kPi / 2);
  EXPECT_FLOAT_EQ(fast_atan2(0, -1), kPi);
}

TEST(HalfDiff, InverseOfThePair) {
  for (const auto& [wl, wv] : test::random_pairs(20000, 1)) {
    const HalfDiff a = half_diff(wl, wv);
    const DirectionPair pair = pair_of_half_diff(a.theta_h, a.phi_h, a.theta_d, a.phi_d);
    const float direct = glm::length(pair.wl - wl) + glm::length(pair.wv - wv);
    const float exchanged = glm::length(pair.wl - wv) + glm::length(pair.wv - wl);
    EXPECT_LT(std::min(direct, exchanged), 1e-5f);
  }
}

TEST(HalfDiff, ReciprocalAndTurning) {
  for (const auto& [wl, wv] : test::random_pairs(5000, 2)) {
    const HalfDiff a = half_diff(wl, wv), b = half_diff(wv, wl);
    EXPECT_EQ(a.theta_h, b.theta_h);
    EXPECT_EQ(a.theta_d, b.theta_d);
    EXPECT_LT(std::abs(std::sin(a.phi_d - b.phi_d)), 1e-5f);  // equal, or 0 against pi
    const HalfDiff c = half_diff(test::rotated(wl, 0.7f), test::rotated(wv, 0.7f));
    EXPECT_NEAR(c.theta_h, a.theta_h, 1e-5f);
    EXPECT_LT(std::abs(std::sin(c.phi_d - a.phi_d)) * std::sin(a.theta_h) * std::sin(a.theta_d), 1e-5f);
    EXPECT_LT(std::abs(std::sin(0.5f * (c.phi_h - a.phi_h - 0.7f))) * std::sin(a.theta_h), 1e-5f);
  }
}

TEST(HalfDiff, DegeneratePairsAreFinite) {
  const Vec3 n(0, 0, 1), w = direction(0.7f, 1.0f), mirror(-w.x, -w.y, w.z);
  for (const auto& [wl, wv] :
       {std::pair{n, n}, {w, w}, {w, mirror}, {direction(1.5707f, 0), direction(1.5707f, kPi)}}) {
    const HalfDiff a = half_diff(wl, wv);
    for (const float angle : {a.theta_h, a.phi_h, a.theta_d, a.phi_d}) EXPECT_TRUE(std::isfinite(angle));
  }
  EXPECT_EQ(half_diff(w, w).theta_d, 0.0f);
  EXPECT_EQ(half_diff(w, mirror).theta_h, 0.0f);
}

HalfDiffTable numbered(const BrdfTableLayout& layout, const std::function<bool(size_t)>& valid) {
  std::vector<TableNode> nodes(layout.size());
  for (size_t i = 0; i < nodes.size(); ++i)
    if (valid(i)) nodes[i] = {{static_cast<float>(i), 1.0f, -1.0f, 1.0f}};
  return {layout, nodes};
}

TEST(HalfDiffTable, GivesItsNodes) {
  const BrdfTableLayout layout{.theta_h = 9, .phi_h = 5, .theta_d = 7, .phi_d = 6, .folds = 2, .theta_h_power = 1.5};
  const HalfDiffTable table = numbered(layout, [](size_t) { return true; });
  for (int i = 1; i < layout.theta_h; ++i)
    for (int j = 0; j < layout.phi_h; ++j)
      for (int k = 1; k < layout.theta_d; ++k)
        for (int l = 1; l < layout.phi_d; ++l) {
          const DirectionPair pair = layout.pair(i, j, k, l);
          if (pair.wl.z <= 1e-4f || pair.wv.z <= 1e-4f) continue;
          Rgb f;
          ASSERT_TRUE(table.lookup(pair.wl, pair.wv, f));
          EXPECT_NEAR(f.r, static_cast<float>(layout.index(i, j, k, l)), 0.02f) << i << j << k << l;
          EXPECT_FLOAT_EQ(f.g, 1.0f);
          EXPECT_FLOAT_EQ(f.b, -1.0f);
        }
}

TEST(HalfDiffTable, InvalidNodesDoNotDarken) {
  const BrdfTableLayout layout{.theta_h = 8, .phi_h = 1, .theta_d = 8, .phi_d = 8};
  const HalfDiffTable table = numbered(layout, [](size_t i) { return i % 3 != 0; });
  const HalfDiffTable empty = numbered(layout, [](size_t) { return false; });
  int covered = 0;
  for (const auto& [wl, wv] : test::random_pairs(3000, 3)) {
    Rgb f;
    if (table.lookup(wl, wv, f)) {
      ++covered;
      EXPECT_FLOAT_EQ(f.g, 1.0f);
    }
    EXPECT_FALSE(empty.lookup(wl, wv, f));
    EXPECT_EQ(f, Rgb(0.0f));
  }
  EXPECT_GT(covered, 2900);
}

}  // namespace
}  // namespace velour::half_diff_test
