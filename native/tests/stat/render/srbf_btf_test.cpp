// Pictures of BTFs as sums of multivariate SRBFs: all strategies have the same expectation.
#include <gtest/gtest.h>

#include "material/srbf_btf_material.h"
#include "support/btf_scenes.h"
#include "support/example_srbf.h"
#include "support/significance.h"

namespace velour {
namespace {

std::shared_ptr<const Material> example_material() {
  return make_srbf_btf_material(std::make_shared<const SrbfBtf>(test::example_srbf(true)));
}

TEST(SrbfBtf, AllStrategiesHaveTheSameExpectation) {
  const Scene scene = test::two_objects(example_material());
  const auto expected = test::strategy_means(scene, {"mis", Strategy::mis}, 8, 1'000'000);
  test::ZTests tests(0.01);
  for (const test::NamedStrategy& s : test::all_strategies()) {
    compare(s.name, test::strategy_means(scene, s), expected, tests);
  }
  EXPECT_TRUE(tests.agree());
  for (const test::NamedStrategy& s : test::all_strategies()) {
    EXPECT_LT(tests.smallest_bias(s.name + " whole"), 0.05) << s.name;
  }
}

TEST(SrbfBtf, ControlLightFivePercentTooBrightIsSeen) {
  const auto expected =
      test::strategy_means(test::two_objects(example_material()), {"mis", Strategy::mis}, 8, 1'000'000);
  test::ZTests tests;
  const Scene brighter = test::two_objects(example_material(), 1.05f);
  compare("brighter", test::strategy_means(brighter, {"mis", Strategy::mis}), expected, tests);
  EXPECT_TRUE(tests.differ());
}

}  // namespace
}  // namespace velour
