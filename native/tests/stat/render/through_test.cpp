// Pictures of surfaces that let light through: all strategies have the same expectation, no light is lost or made, and
// they look like the geometry that they were captured from.
#include <gtest/gtest.h>

#include "btf/eval/measured_btf_material.h"
#include "btf/eval/sided_btf_material.h"
#include "math/sphere/frame.h"
#include "support/captured.h"
#include "support/level.h"
#include "support/strategy_agreement.h"
#include "support/through_btfs.h"
#include "votf/capture/votf_capture.h"

namespace velour::through_test {
namespace {

template <typename Kind>
class Through : public ::testing::Test {};
TYPED_TEST_SUITE(Through, test::SidedBtfKinds, test::SidedBtfNames);

template <typename Kind>
Scene finest_level(float light = 1) {
  auto btf = test::with_through(Kind::glossy());
  for (auto& side : btf.sides) side.levels.resize(1);
  return test::two_objects(test::through_material<Kind>(btf), light);
}

TYPED_TEST(Through, AllStrategiesHaveTheSameExpectation) {
  if (std::is_same_v<TypeParam, test::TensorKind>) VELOUR_LONG_TEST();
  test::expect_strategies_agree(finest_level<TypeParam>(), 0.06, 0.4);
}

TYPED_TEST(Through, ControlLightFivePercentTooBrightIsSeen) {
  test::expect_a_difference(finest_level<TypeParam>(), finest_level<TypeParam>(1.05f));
}

/// The mean pixel of a sheet under an even sky of 1 all around it, of which `reflected` comes back and `through` comes
/// through; seen from `height`.
template <typename Kind>
double furnace(float reflected, float through, float height, Strategy strategy) {
  auto btf = Kind::even(reflected / kPi);
  for (const auto& [view, light] : {std::pair(false, true), {true, false}, {true, true}}) {
    auto side = view == light ? btf.sides[0] : Kind::even(through / kPi).sides[0];
    side.view_below = view;
    side.light_below = light;
    btf.sides.push_back(side);
  }
  std::vector<PolarAngles> views = btf.layout.views(), lights = btf.layout.lights();
  for (const PolarAngles& d : below(views)) views.push_back(d);
  for (const PolarAngles& d : below(lights)) lights.push_back(d);
  btf.layout = PairLayout(views, lights);
  Scene scene;
  const uint32_t material = scene.add_material({.material = test::through_material<Kind>(btf)});
  scene.add_instance(scene.add_mesh(test::repeating_square(3, 20)), {}, {material});
  scene.set_environment(Environment::constant(Rgb(1.0f)));
  scene.set_camera(Camera::look_at({0, -1, height}, {0, 0, 0}, {0, 0, 1}, 0.22f, 1));
  scene.commit(2);
  RenderOptions options = test::small_options(strategy, 256);
  options.bounces = 2;
  return test::mean_of(test::rendered(scene, options));
}

TYPED_TEST(Through, WhiteIsNotSeenInAFurnaceFromEitherSide) {
  for (const float height : {2.0f, -2.0f}) {
    for (const Strategy strategy : {Strategy::srbf, Strategy::cosine, Strategy::mis}) {
      EXPECT_NEAR(furnace<TypeParam>(0.7f, 0.3f, height, strategy), 1.0, 0.01);
      EXPECT_NEAR(furnace<TypeParam>(0.2f, 0.75f, height, strategy), 0.95, 0.01);
    }
  }
}

/// Steep slats along y, open to light from below; period 1.
Mesh slats(int periods) {
  test::Corners c;
  const auto half = static_cast<float>(periods) / 2;
  for (int k = 0; k < periods; ++k) {
    const float x = static_cast<float>(k) - half, y = periods == 1 ? 0.5f : half;
    const float at = periods == 1 ? 0.0f : x, from = periods == 1 ? 0.0f : -y, to = periods == 1 ? 1.0f : y;
    c.quad({at + 0.3f, from, -0.35f}, {at + 0.55f, from, 0.35f}, {at + 0.55f, to, 0.35f}, {at + 0.3f, to, -0.35f});
  }
  return c.mesh();
}

/// The same as bars of some thickness, which have an inside.
Mesh bars(int periods) {
  test::Corners c;
  const Vec2 section[] = {{0.55f, 0.35f}, {0.65f, 0.35f}, {0.4f, -0.35f}, {0.3f, -0.35f}};
  const auto half = static_cast<float>(periods / 2), from = -half, to = periods == 1 ? 1.0f : half;
  for (int k = 0; k < periods; ++k) {
    for (int i = 0; i < 4; ++i) {
      const Vec2 shift(static_cast<float>(k) - half, 0), p = section[i] + shift, q = section[(i + 1) % 4] + shift;
      c.quad({p.x, from, p.y}, {q.x, from, q.y}, {q.x, to, q.y}, {p.x, to, p.y});
    }
  }
  return c.mesh();
}

const PolarAngles kView{20, 100}, kBehind{123, 10}, kFront{40, 30}, kViewFromBelow{160, 100};

std::shared_ptr<const BtfTable> captured(Mesh mesh, const std::vector<PolarAngles>& views,
                                         const std::vector<PolarAngles>& lights, uint32_t texels = 16) {
  const auto tile = test::tile_of(std::move(mesh), std::make_shared<test::Lambert>(0.8f));
  BtfCaptureOptions options = test::small_capture(views, lights);
  options.texels[0] = options.texels[1] = texels;
  options.sampling.samples = 64;
  options.sampling.bounces = 4;
  const test::ScratchFolder folder("slats");
  Progress progress;
  capture_btf(*tile, options, folder.path(), progress);
  return read_btf_table(*load_btf_folder(folder.path()));
}

std::shared_ptr<const Material> through_of(const std::shared_ptr<const BtfTable>& table) {
  return std::make_shared<const ThroughMaterial>(make_measured_btf_material(table),
                                                 make_measured_btf_material(table, BtfLight::other_side));
}

std::shared_ptr<const ShellField> shell_of(Mesh mesh) {
  const auto tile = test::tile_of(std::move(mesh), std::make_shared<test::Lambert>(0.8f));
  VotfCaptureOptions options;
  options.place.period = {1, 1};
  options.reference_height = 0;
  options.check_views = 0;
  Progress progress;
  return std::make_shared<const ShellField>(
      std::make_shared<const VotfVolume>(capture_votf(*tile, options, progress).volume));
}

/// The middle of many tiles from far away, in a sun that shines from behind them alone.
double lit_from_behind(Mesh mesh, SurfaceMaterial material, const PolarAngles& view = kView,
                       const PolarAngles& sun_at = kBehind) {
  Scene scene;
  const uint32_t number = scene.add_material(std::move(material));
  scene.add_instance(scene.add_mesh(std::move(mesh)), {}, {number});
  Light sun;
  const Frame frame = Frame::about(unit_direction(sun_at));
  for (int i = 0; i < 3; ++i) {
    sun.light_to_world.m[4 * i] = frame.x[i];
    sun.light_to_world.m[4 * i + 1] = frame.y[i];
    sun.light_to_world.m[4 * i + 2] = frame.z[i];
  }
  scene.add_light(sun);
  scene.set_camera(Camera::look_at(400.0f * Vec3(unit_direction(view)), {0, 0, 0}, {0, 1, 0}, 0.03f, 1));
  scene.commit(2);
  RenderOptions options = test::small_options(Strategy::mis, 1024);
  options.width = options.height = 32;
  options.bounces = 4;
  return test::mean_of(test::rendered(scene, options), 1);
}

TEST(ThroughGeometry, SlatsThatAreLitFromBehindLookLikeTheirGeometry) {
  const auto table = captured(slats(1), {kView, kViewFromBelow}, {kFront, kBehind});
  const auto reflecting = make_measured_btf_material(table), through = through_of(table);
  const double geometry = lit_from_behind(slats(40), {std::make_shared<test::Lambert>(0.8f)});
  EXPECT_GT(geometry, 0.01);
  EXPECT_NEAR(lit_from_behind(test::repeating_square(20, 40), {through}), geometry, 0.02 * geometry);
  // The control: what does not let light through is black.
  EXPECT_EQ(lit_from_behind(test::repeating_square(20, 40), {reflecting}), 0);
}

/// With an outline rays find the holes, and what texels hold beside a bar is folded into it: up to 7 % too bright where
/// bars are a texel or two wide.
TEST(ThroughGeometry, BarsWithAnOutlineLookLikeTheirGeometry) {
  const auto table = captured(bars(1), {kView, kViewFromBelow}, {kFront, kBehind}, 96);
  const auto shell = shell_of(bars(1));
  const auto shelled = [&](std::shared_ptr<const Material> btf) {
    return SurfaceMaterial{.material = std::make_shared<const HoledBtfMaterial>(std::move(btf)), .shell = shell};
  };
  for (const auto& [view, sun] : {std::pair(kView, kBehind), {kViewFromBelow, kFront}}) {
    const double geometry = lit_from_behind(bars(40), {std::make_shared<test::Lambert>(0.8f)}, view, sun);
    const auto sheet = [&](SurfaceMaterial material) {
      return lit_from_behind(test::repeating_square(20, 40), std::move(material), view, sun);
    };
    EXPECT_GT(geometry, 0.01);
    EXPECT_NEAR(sheet(shelled(through_of(table))), geometry, 0.03 * geometry);
    EXPECT_EQ(sheet(shelled(make_measured_btf_material(table))), 0);
  }
}

/// Light that goes from behind to the front, and as much back (Helmholtz): means over the tile, within the capture's
/// noise.
TEST(ThroughGeometry, FrontAndBackAreReciprocal) {
  const auto table = captured(slats(1), {kView, kBehind}, {kView, kBehind});
  const auto through = make_measured_btf_material(table, BtfLight::other_side);
  ScratchArena arena;
  const auto mean = [&](bool back) {
    const Vec3 view = unit_direction(back ? kBehind : kView), light = unit_direction(back ? kView : kBehind);
    double sum = 0;
    for (uint32_t t = 0; t < 256; ++t) {
      const Vec2 uv = (Vec2(t % 16, t / 16) + 0.5f) / 16.0f;
      const PreparedBrdf* const point =
          through->prepare({view.x, view.y, std::abs(view.z)}, {.uv = uv, .back = back}, {}, arena);
      sum += static_cast<double>(point->eval_one({light.x, light.y, std::abs(light.z)}).f.g) / 256;
    }
    return sum;
  };
  EXPECT_GT(mean(false), 0.01);
  EXPECT_NEAR(mean(true), mean(false), 0.02 * mean(false));
}

}  // namespace
}  // namespace velour::through_test
