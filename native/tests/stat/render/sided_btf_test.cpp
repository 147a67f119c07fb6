// Pictures of models of BTFs that are made of sides: all strategies have the same expectation, and no light is lost or
// made.
#include <gtest/gtest.h>

#include "support/level.h"
#include "support/sided_btfs.h"
#include "support/strategy_agreement.h"

namespace velour::sided_btf_test {
namespace {

template <typename Kind>
class SidedBtf : public ::testing::Test {};
TYPED_TEST_SUITE(SidedBtf, test::SidedBtfKinds, test::SidedBtfNames);

/// Its finest level alone. A pixel of more camera rays looks at finer levels, and those of the examples have numbers of
/// their own: renders of more samples would have another expectation.
template <typename Kind>
Scene finest_level(float light = 1) {
  auto btf = Kind::example(true);
  for (auto& side : btf.sides) side.levels.resize(1);
  return test::two_objects(Kind::material(btf), light);
}

TYPED_TEST(SidedBtf, AllStrategiesHaveTheSameExpectation) {
  if (std::is_same_v<TypeParam, test::SrbfKind>) VELOUR_LONG_TEST();  // Through has it in the short suite
  test::expect_strategies_agree(finest_level<TypeParam>(), 0.05, 0.5);
}

TYPED_TEST(SidedBtf, ControlLightFivePercentTooBrightIsSeen) {
  test::expect_a_difference(finest_level<TypeParam>(), finest_level<TypeParam>(1.05f));
}

/// Without products `product` is `mis` bit for bit, so a pixel that differs has them.
TYPED_TEST(SidedBtf, ProductsOfAHighlightAndTheSkyAreMade) {
  const Scene scene = test::two_objects(TypeParam::material(TypeParam::glossy()));
  RenderOptions options = test::small_options(Strategy::mis);
  options.sequence = Sequence::random;
  const auto mis = test::rendered(scene, options);
  options.strategy = Strategy::product;
  const auto product = test::rendered(scene, options);
  size_t differ = 0;
  for (size_t i = 1; i < mis.size(); i += 4) differ += mis[i] != product[i];
  EXPECT_GT(differ, mis.size() / 8);
}

/// The mean pixel of a sphere of f = albedo / pi that fills the picture, under an even sky of 1.
template <typename Kind>
double furnace(float albedo) {
  Scene scene;
  const uint32_t material = scene.add_material({.material = Kind::material(Kind::even(albedo / kPi))});
  scene.add_instance(scene.add_mesh(test::textured_sphere(48)), {}, {material});
  scene.set_environment(Environment::constant(Rgb(1.0f)));
  scene.set_camera(Camera::look_at({0, -6, 3}, {0, 0, 0}, {0, 0, 1}, 0.22f, 1));
  scene.commit(2);
  RenderOptions options = test::small_options(Strategy::srbf, 256);
  options.bounces = 8;
  return test::mean_of(test::rendered(scene, options));
}

TYPED_TEST(SidedBtf, WhiteIsNotSeenInAFurnace) {
  EXPECT_NEAR(furnace<TypeParam>(1), 1.0, 1e-3);
  EXPECT_NEAR(furnace<TypeParam>(0.95f), 0.95, 1e-3);
}

}  // namespace
}  // namespace velour::sided_btf_test
