// The choice among many lights.
#include "render/light_tree.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "sphere/random.h"

namespace velour {
namespace {

std::vector<LightTree::Light> scattered(size_t count) {
  std::vector<LightTree::Light> lights;
  RandomStream random(7, 7, 7);
  for (size_t i = 0; i < count; ++i) {
    const Vec3 at(10 * random.next(), 4 * random.next(), random.next());
    LightTree::Light light{{}, std::pow(10.0f, 6 * random.next() - 3)};
    light.box.add(at);
    light.box.add(at + Vec3(0.1f * random.next()));
    lights.push_back(light);
  }
  return lights;
}

TEST(LightTree, ProbabilitiesAddUpToOneAndNoneIsZero) {
  for (const size_t count : {1u, 2u, 3u, 17u, 1000u}) {
    const LightTree tree(scattered(count), Progress());
    for (const Vec3& position : {Vec3(0), Vec3(5, 2, 0.5f), Vec3(1e6f, 0, 0)}) {
      double sum = 0;
      for (uint32_t i = 0; i < count; ++i) {
        const double p = tree.probability(position, i);
        EXPECT_GT(p, 0);
        sum += p;
      }
      EXPECT_NEAR(sum, 1, 1e-9);
    }
  }
}

/// Numbers side by side choose each light in its share of them, one after the other, and what is left of them grows.
TEST(LightTree, ChoosesEachLightInOnePieceOfItsProbability) {
  constexpr uint32_t kCount = 40;
  constexpr int kNumbers = 1 << 20;
  const LightTree tree(scattered(kCount), Progress());
  const Vec3 position(4, 1, 0);
  std::vector<int> chosen(kCount);
  std::vector<double> last(kCount, -1);
  uint32_t before = kCount;
  int changes = 0;
  for (int i = 0; i < kNumbers; ++i) {
    double x = (i + 0.5) / kNumbers;
    const uint32_t light = tree.choose(position, x);
    changes += light != before;
    before = light;
    ++chosen[light];
    EXPECT_GT(x, last[light]);
    EXPECT_LT(x, 1);
    last[light] = x;
  }
  EXPECT_LE(changes, static_cast<int>(kCount));
  for (uint32_t i = 0; i < kCount; ++i) {
    EXPECT_NEAR(chosen[i], tree.probability(position, i) * kNumbers, 2) << i;
  }
}

TEST(LightTree, TheNearOneOfTwoAlikeIsTheLikelierOne) {
  std::vector<LightTree::Light> lights(2, {{Vec3(0), Vec3(0.1f)}, 1});
  lights[1].box = {Vec3(10, 0, 0), Vec3(10.1f, 0.1f, 0.1f)};
  const LightTree tree(lights, Progress());
  EXPECT_GT(tree.probability({1, 0, 0}, 0), 0.95);
  EXPECT_LT(tree.probability({9, 0, 0}, 0), 0.05);
  EXPECT_NEAR(tree.probability({5.05f, 0, 0}, 0), 0.5, 1e-6);
}

TEST(LightTree, LightsOfOnePointAreChosenByPower) {
  std::vector<LightTree::Light> lights(3, {{Vec3(1), Vec3(1)}, 1});
  lights[2].power = 6;
  const LightTree tree(lights, Progress());
  for (const Vec3& position : {Vec3(0), Vec3(1)}) EXPECT_NEAR(tree.probability(position, 2), 0.75, 1e-6);
  EXPECT_EQ(tree.power(), 8);
  EXPECT_TRUE(LightTree().empty());
}

TEST(LightTree, IsNotBuiltAfterACancel) {
  Progress cancelled;
  cancelled.cancel();
  EXPECT_THROW(LightTree(scattered(1), cancelled), Error);
}

/// Of many lights it takes seconds: a cancel in between ends it long before.
TEST(LightTree, EndsSoonAfterACancel) {
  const auto lights = scattered(300000);
  const auto seconds_of_build = [&](Progress& progress) {
    const auto start = std::chrono::steady_clock::now();
    try {
      const LightTree tree(lights, progress);
      EXPECT_FALSE(progress.cancelled());
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), Status::cancelled);
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  Progress progress;
  const double whole = seconds_of_build(progress);
  std::thread canceller([&] {
    std::this_thread::sleep_for(std::chrono::duration<double>(0.3 * whole));
    progress.cancel();
  });
  EXPECT_LT(seconds_of_build(progress), 0.8 * whole);
  canceller.join();
  EXPECT_TRUE(progress.cancelled());
}

}  // namespace
}  // namespace velour
