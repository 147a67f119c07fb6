// What pictures by all strategies must have in common.
#pragma once

#include <gtest/gtest.h>

#include "support/btf_scenes.h"
#include "support/significance.h"

namespace velour::test {

inline PictureMeans by_many_samples(const Scene& scene, double effort = 1) {
  return strategy_means(scene, {"mis", Strategy::mis}, 8 * effort, 1'000'000);
}

/// All strategies have the same expectation; a bias of the whole picture above `bias` would have been seen. `effort`:
/// factor of the samples.
inline void expect_strategies_agree(const Scene& scene, double bias, double effort) {
  const PictureMeans expected = by_many_samples(scene, effort);
  ZTests tests(0.01);
  for (const NamedStrategy& s : all_strategies()) compare(s.name, strategy_means(scene, s, effort), expected, tests);
  EXPECT_TRUE(tests.agree());
  for (const NamedStrategy& s : all_strategies()) EXPECT_LT(tests.smallest_bias(s.name + " whole"), bias) << s.name;
}

/// The negative control: `other`, the scene with its light five percent brighter, is seen to differ.
inline void expect_a_difference(const Scene& scene, const Scene& other) {
  ZTests tests;
  compare("brighter", strategy_means(other, {"mis", Strategy::mis}), by_many_samples(scene), tests);
  EXPECT_TRUE(tests.differ());
}

}  // namespace velour::test
