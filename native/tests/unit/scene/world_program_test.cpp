// Worlds that a program computes.

#include "scene/world_program.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "scene/scene.h"
#include "support/programs.h"

namespace velour::test {
namespace {

std::shared_ptr<const Program> program_of(Source source) {
  ProgramDescription given = description_of(Operation::source, {static_cast<int32_t>(source), 0, 0}, {});
  given.outputs = {{.first = 0}};
  return std::make_shared<const Program>(given);
}

DirectionBatch axes() {
  DirectionBatch batch;
  for (const Vec3& d : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
    batch.push(d);
    batch.push(-d);
  }
  batch.pad();
  return batch;
}

TEST(WorldProgram, IsBakedByDirection) {
  const WorldProgram world(program_of(Source::incoming), 0);
  EXPECT_FALSE(world.even());
  const Environment baked = world.baked(256, 128);
  const DirectionBatch directions = axes();
  RgbBatch seen;
  world.look_up(directions, WorldRays::others, seen);
  for (int i = 0; i < directions.count; ++i) {
    const Rgb expected = glm::max(-directions.get(i), Vec3(0.0f));
    EXPECT_EQ(seen.get(i), expected);
    const Rgb found = baked.radiance(directions.get(i));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 0.02f) << i;
  }
  EXPECT_NEAR(baked.mean_luminance(), 0.25f, 1e-3f);  // of a cosine on one half
}

TEST(WorldProgram, IsAColorIfNoDirectionCounts) {
  const WorldProgram world(program_of(Source::camera_ray), 0);
  EXPECT_TRUE(world.even());
  EXPECT_EQ(world.baked(256, 128).equirectangular(), nullptr);
  EXPECT_TRUE(world.baked(256, 128).black());
}

TEST(WorldProgram, IsSeenByCameraRaysWhileItsImageLightsTheScene) {
  Scene scene;
  scene.set_world(WorldProgram(program_of(Source::camera_ray), 0), 8, 4);
  RgbBatch seen;
  scene.look_up_background(axes(), seen);
  EXPECT_EQ(seen.get(0), Rgb(1.0f));
  EXPECT_TRUE(scene.environment().black());
  scene.set_environment(Environment::constant(Rgb(0.5f)));
  scene.look_up_background(axes(), seen);
  EXPECT_EQ(seen.get(0), Rgb(0.5f));
}

TEST(WorldProgram, NeedsAColor) {
  const auto program = program_of(Source::position);
  EXPECT_THROW(WorldProgram(program, 1), Error);
  ProgramDescription given = description_of(Operation::source, {static_cast<int32_t>(Source::normal), 0, 0}, {});
  given.outputs = {{.first = 0, .is_normal = true}};
  EXPECT_THROW(WorldProgram(std::make_shared<const Program>(given), 0), Error);
}

}  // namespace
}  // namespace velour::test
