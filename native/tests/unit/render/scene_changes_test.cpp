// A committed scene that changes is the scene that would have been built like that at once.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "base/error.h"
#include "render/scene_samplers.h"
#include "support/example_shell.h"
#include "support/test_scene.h"

namespace velour::scene_changes_test {
namespace {

using test::rendered;
using test::shift;
using test::small_options;

std::shared_ptr<const Material> gray(float albedo) { return std::make_shared<test::Lambert>(albedo); }

void begin(Scene& scene) {
  scene.add_material({gray(0.5f), Rgb(0.0f), false});
  scene.add_material({gray(0.2f), Rgb(0.0f), false});
  scene.set_environment(Environment::constant(Rgb(1.0f)));
  scene.set_camera(test::camera_above(2));
}

void add_ground_and_ball(Scene& scene, const Vec3& place) {
  const uint32_t ground = scene.add_mesh(test::square(3)), ball = scene.add_mesh(test::sphere(12));
  scene.add_instance(ground, {}, {0});
  scene.add_instance(ball, shift(place), {1});
}

using Change = std::function<void(Scene&)>;

/// `change` after a first commit against a scene that `expected` makes at once.
void expect_same(const Change& change, const Change& expected) {
  Scene changed, fresh;
  begin(changed);
  add_ground_and_ball(changed, {0, 0, 1});
  changed.commit(2);
  const RenderOptions options = small_options(Strategy::mis, 16);
  const std::vector<float> before = rendered(changed, options);
  change(changed);
  changed.commit(2);
  begin(fresh);
  expected(fresh);
  fresh.commit(2);
  const std::vector<float> after = rendered(changed, options);
  EXPECT_NE(after, before) << "the change changes nothing";
  EXPECT_EQ(after, rendered(fresh, options));
  EXPECT_EQ(changed.info().instances, fresh.info().instances);
  EXPECT_EQ(changed.info().triangles, fresh.info().triangles);
}

TEST(SceneChanges, InstancesMove) {
  expect_same(
      [](Scene& s) {
        s.clear_instances();
        s.add_instance(0, {}, {0});
        s.add_instance(1, shift({0.5f, 0, 1}), {1});
      },
      [](Scene& s) {
        add_ground_and_ball(s, {0.5f, 0, 1});
      });
}

TEST(SceneChanges, AMeshGivesWayToAnother) {
  expect_same(
      [](Scene& s) {
        s.clear_instances();
        const uint32_t coarse = s.add_mesh(test::sphere(5));
        s.add_instance(0, {}, {0});
        s.add_instance(coarse, shift({0, 0, 1}), {1});
        s.remove_mesh(1);
      },
      [](Scene& s) {
        const uint32_t ground = s.add_mesh(test::square(3)), ball = s.add_mesh(test::sphere(5));
        s.add_instance(ground, {}, {0});
        s.add_instance(ball, shift({0, 0, 1}), {1});
      });
}

TEST(SceneChanges, AMaterialGainsLight) {
  expect_same([](Scene& s) { s.set_gain(0, Rgb(0.5f)); },
              [](Scene& s) {
                s.set_material(0, {gray(0.25f), Rgb(0.0f), false});
                add_ground_and_ball(s, {0, 0, 1});
              });
}

TEST(SceneChanges, AGainIsOfEachChannelAndStays) {
  Scene scene;
  begin(scene);
  scene.add_instance(scene.add_mesh(test::square(9)), {}, {0});
  scene.commit(1);
  const RenderOptions options = small_options(Strategy::mis, 16);
  const std::vector<float> before = rendered(scene, options);
  const Rgb gain(2, 1, 0.25f);
  scene.set_gain(0, gain);
  scene.set_material(0, {gray(0.5f), Rgb(0.0f), false});
  const std::vector<float> after = rendered(scene, options);
  ASSERT_EQ(after.size() % 4, 0u);
  for (size_t i = 0; i < after.size(); ++i) {
    EXPECT_EQ(after[i], before[i] * (i % 4 < 3 ? gain[static_cast<int>(i % 4)] : 1)) << i;
  }
}

TEST(SceneChanges, NonsensicalGainsAreRefused) {
  Scene scene;
  begin(scene);
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  for (const float bad : {-0.1f, nan, infinity}) EXPECT_THROW(scene.set_gain(0, Rgb(1, bad, 1)), Error) << bad;
  EXPECT_THROW(scene.set_gain(2, Rgb(1)), Error);
  scene.set_gain(1, Rgb(0));
}

TEST(SceneChanges, AnInstanceIsAloneAndHasCompanyAgain) {
  expect_same(
      [](Scene& s) {
        s.clear_instances();
        s.add_instance(0, {}, {0});
        s.commit(2);
        s.add_instance(1, shift({0, 0.5f, 1}), {1});
      },
      [](Scene& s) {
        add_ground_and_ball(s, {0, 0.5f, 1});
      });
}

TEST(SceneChanges, LightsAndWorld) {
  expect_same(
      [](Scene& s) {
        s.add_light({});
        s.commit(2);
        s.clear_lights();
        s.set_environment(Environment::constant(Rgb(0.25f)));
      },
      [](Scene& s) {
        add_ground_and_ball(s, {0, 0, 1});
        s.set_environment(Environment::constant(Rgb(0.25f)));
      });
}

TEST(SceneChanges, MaterialsAreReplaced) {
  expect_same(
      [](Scene& s) {
        s.add_material({gray(0.8f), Rgb(0.0f), false});
        s.replace_material(1);
        EXPECT_EQ(s.materials().size(), 2u);
      },
      [](Scene& s) {
        s.add_material({gray(0.8f), Rgb(0.0f), false});
        const uint32_t ground = s.add_mesh(test::square(3)), ball = s.add_mesh(test::sphere(12));
        s.add_instance(ground, {}, {0});
        s.add_instance(ball, shift({0, 0, 1}), {2});
      });
}

TEST(SceneChanges, TheCameraAloneIsNoRevision) {
  Scene scene;
  begin(scene);
  add_ground_and_ball(scene, {0, 0, 1});
  scene.commit(2);
  const uint64_t before = scene.revision();
  const uint64_t bytes = scene.info().bytes;
  scene.set_camera(test::camera_above(3));
  EXPECT_FALSE(scene.committed());
  scene.commit(2);
  EXPECT_EQ(scene.revision(), before);
  EXPECT_EQ(scene.info().bytes, bytes);
  scene.clear_lights();
  EXPECT_NE(scene.revision(), before);
}

TEST(SceneChanges, MemoryDoesNotGrow) {
  Scene scene;
  begin(scene);
  add_ground_and_ball(scene, {0, 0, 1});
  scene.commit(2);
  const uint64_t bytes = scene.info().bytes;
  uint32_t ball = 1;
  for (int i = 0; i < 50; ++i) {
    scene.clear_instances();
    const uint32_t next = scene.add_mesh(test::sphere(12));
    scene.add_instance(0, {}, {0});
    scene.add_instance(next, shift({0, 0, 1}), {1});
    scene.remove_mesh(ball);
    ball = next;
    scene.commit(2);
  }
  EXPECT_LT(scene.info().bytes, bytes + bytes / 2);
}

/// A square of `wide` tiles across whose wires stand over it, above the ground.
void add_wires(Scene& scene, float wide) {
  const std::vector<Vec3> p = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  const std::vector<glm::uvec3> t = {{0, 1, 2}, {0, 2, 3}};
  std::vector<Vec2> uv;
  for (const glm::uvec3& corner : t) {
    for (int k = 0; k < 3; ++k) uv.push_back(wide * Vec2(p[corner[k]]));
  }
  const uint32_t wires = scene.add_material({.material = gray(0.8f),
                                             .rec709_colors = false,
                                             .shell = std::make_shared<const ShellField>(test::wires(64, 0.1f)),
                                             .shell_shaded = true});
  const uint32_t mesh = scene.add_mesh(Mesh({.positions = p, .triangles = t, .corner_uvs = uv}));
  scene.add_instance(mesh, shift({0, 0, 0.5f}), {wires});
}

/// The scene of expect_same() with wires over the ground and the ball at `place`.
void begin_with_wires(Scene& scene, const Vec3& place, float wide) {
  begin(scene);
  const uint32_t ground = scene.add_mesh(test::square(3)), ball = scene.add_mesh(test::sphere(12));
  add_wires(scene, wide);
  scene.add_instance(ground, {}, {0});
  scene.add_instance(ball, shift(place), {1});
}

TEST(SceneChanges, AShellStaysWhereAnotherObjectMoves) {
  Scene changed, fresh;
  begin_with_wires(changed, {0, 0, 1}, 1);
  changed.commit(2);
  const Scene::Instance before = changed.instances()[0];
  changed.clear_instances();
  changed.add_instance(2, shift({0, 0, 0.5f}), {2});
  changed.add_instance(0, {}, {0});
  changed.add_instance(1, shift({0.5f, 0, 1}), {1});
  changed.commit(2);
  begin_with_wires(fresh, {0.5f, 0, 1}, 1);
  fresh.commit(2);
  ASSERT_NE(before.top, nullptr);
  EXPECT_EQ(changed.instances()[0].top, before.top) << "its top was made anew";
  EXPECT_EQ(changed.instances()[0].traced, before.traced);
  const RenderOptions options = small_options(Strategy::mis, 16);
  EXPECT_EQ(rendered(changed, options), rendered(fresh, options));
}

TEST(SceneChanges, AShellOfAnotherHeightIsMadeAnew) {
  Scene changed, fresh;
  begin_with_wires(changed, {0, 0, 1}, 1);
  changed.commit(2);
  const RenderOptions options = small_options(Strategy::mis, 16);
  const std::vector<float> before = rendered(changed, options);
  const uint64_t bytes = changed.info().bytes;
  for (int i = 50; i >= 0; --i) {
    changed.set_shell_tile(2, 1.5f + 0.01f * static_cast<float>(i));
    changed.commit(2);
  }
  begin_with_wires(fresh, {0, 0, 1}, 1);
  fresh.set_shell_tile(2, 1.5f);
  fresh.commit(2);
  const std::vector<float> after = rendered(changed, options);
  EXPECT_NE(after, before);
  EXPECT_EQ(after, rendered(fresh, options));
  EXPECT_LT(changed.info().bytes, bytes + bytes / 2);
}

TEST(SceneChanges, AShellGivesWayToNone) {
  Scene changed, fresh;
  begin_with_wires(changed, {0, 0, 1}, 1);
  changed.commit(2);
  const SurfaceMaterial plain{.material = gray(0.8f), .rec709_colors = false};
  changed.set_material(2, plain);
  changed.commit(2);
  begin_with_wires(fresh, {0, 0, 1}, 1);
  fresh.set_material(2, plain);
  fresh.commit(2);
  EXPECT_EQ(changed.instances()[0].top, nullptr);
  const RenderOptions options = small_options(Strategy::mis, 16);
  EXPECT_EQ(rendered(changed, options), rendered(fresh, options));
}

TEST(SceneChanges, RefusesToRemoveWhatIsThere) {
  Scene scene;
  begin(scene);
  add_ground_and_ball(scene, {0, 0, 1});
  EXPECT_THROW(scene.remove_mesh(0), Error);
  EXPECT_THROW(scene.remove_mesh(7), Error);
  EXPECT_THROW(scene.replace_material(1), Error);
  EXPECT_THROW(scene.replace_material(9), Error);
}

TEST(SceneChanges, SamplersAreSharedUntilAnythingButTheCameraChanges) {
  Scene scene;
  begin(scene);
  add_ground_and_ball(scene, {0, 0, 1});
  scene.commit(2);
  Progress progress;
  const auto tables = table_samplers(scene, progress);
  const auto lobes = ggx_samplers(scene, 2, progress);
  const auto sky = environment_sampler(scene, "", progress);
  scene.set_camera(test::camera_above(3));
  EXPECT_EQ(table_samplers(scene, progress), tables);
  EXPECT_EQ(ggx_samplers(scene, 2, progress), lobes);
  EXPECT_EQ(environment_sampler(scene, "", progress), sky);
  scene.set_material(0, {gray(0.9f), Rgb(0.0f), false});
  EXPECT_NE(table_samplers(scene, progress), tables);
  EXPECT_NE(ggx_samplers(scene, 2, progress), lobes);
  EXPECT_NE(environment_sampler(scene, "", progress), sky);
}

/// What an earlier render has left must not be drawn from after a change.
TEST(SceneChanges, SamplersOfAnEarlierRenderAreNotUsedAgain) {
  for (const Strategy strategy : {Strategy::table, Strategy::ggx, Strategy::product}) {
    Scene changed, fresh;
    begin(changed), begin(fresh);
    add_ground_and_ball(changed, {0, 0, 1}), add_ground_and_ball(fresh, {0, 0, 1});
    const RenderOptions options = small_options(strategy, 16);
    changed.commit(2);
    (void)rendered(changed, options);
    for (Scene* scene : {&changed, &fresh}) {
      scene->set_material(0, {std::make_shared<test::ThinLambert>(0.3f, 0.5f), Rgb(0.0f), false});
      scene->add_material({gray(0.7f), Rgb(0.0f), false});
      scene->set_environment(Environment::constant(Rgb(0.5f)));
      scene->commit(2);
    }
    EXPECT_EQ(rendered(changed, options), rendered(fresh, options));
  }
}

}  // namespace
}  // namespace velour::scene_changes_test
