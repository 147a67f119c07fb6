// The choice among many lights.
#include "render/lights/light_tree.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "math/sphere/random.h"

namespace velour::light_tree_test {
namespace {

std::vector<LightTree::Light> scattered(size_t count) {
  std::vector<LightTree::Light> lights;
  RandomStream random(7, 7, 7);
  for (size_t i = 0; i < count; ++i) {
    const Vec3 at(10 * random.next(), 4 * random.next(), random.next());
    LightTree::Light light{{}, std::pow(10.0f, 6 * random.next() - 3)};
    light.box.add(at);
    light.box.add(at + Vec3(0.1f * random.next()));
    if (i % 3 != 0) light.cone = {glm::normalize(Vec3(random.next(), random.next() - 0.5f, -1)), 0.9f, 0};
    lights.push_back(light);
  }
  return lights;
}

TEST(LightTree, ProbabilitiesAddUpToOneAndNoneIsZero) {
  for (const size_t count : {1u, 2u, 3u, 17u, 1000u}) {
    const LightTree tree(scattered(count), Progress());
    for (const LightPlace& place :
         {LightPlace{}, LightPlace{{5, 2, 0.5f}, {0, 0, 1}}, LightPlace{{5, 2, 0.5f}, {0, 0, 1}, true},
          LightPlace{{5, 2, 9}, {0, 0.6f, 0.8f}}, LightPlace{{1e6f, 0, 0}}, LightPlace{{1e25f, 0, 0}}}) {
      const LightTree::Cut cut = tree.cut(place);
      double sum = 0, cut_sum = 0;
      for (uint32_t i = 0; i < count; ++i) {
        EXPECT_GT(tree.probability(place, i), 0);
        EXPECT_GT(tree.probability(cut, place, i), 0);
        sum += tree.probability(place, i);
        cut_sum += tree.probability(cut, place, i);
      }
      EXPECT_NEAR(sum, 1, 1e-9);
      EXPECT_NEAR(cut_sum, 1, 1e-9);
    }
  }
}

/// Numbers side by side choose each light in its share of them, one after the other, and what is left of them grows.
TEST(LightTree, ChoosesEachLightInOnePieceOfItsProbability) {
  constexpr uint32_t kCount = 40;
  constexpr int kNumbers = 1 << 20;
  const LightTree tree(scattered(kCount), Progress());
  const LightPlace place{{4, 1, 0}, {0, 0.6f, 0.8f}};
  const LightTree::Cut cut = tree.cut(place);
  for (const bool from_cut : {false, true}) {
    std::vector<int> chosen(kCount);
    std::vector<double> last(kCount, -1);
    uint32_t before = kCount;
    int changes = 0;
    for (int i = 0; i < kNumbers; ++i) {
      double x = (i + 0.5) / kNumbers;
      const uint32_t light = from_cut ? tree.choose(cut, place, x) : tree.choose(place, x);
      changes += light != before;
      before = light;
      ++chosen[light];
      EXPECT_GT(x, last[light]);
      EXPECT_LT(x, 1);
      last[light] = x;
    }
    EXPECT_LE(changes, static_cast<int>(kCount));
    for (uint32_t i = 0; i < kCount; ++i) {
      const double p = from_cut ? tree.probability(cut, place, i) : tree.probability(place, i);
      EXPECT_NEAR(chosen[i], p * kNumbers, 2) << i;
    }
  }
}

TEST(LightTree, TheNearOneOfTwoAlikeIsTheLikelierOne) {
  std::vector<LightTree::Light> lights(2, {{Vec3(0), Vec3(0.1f)}, 1});
  lights[1].box = {Vec3(10, 0, 0), Vec3(10.1f, 0.1f, 0.1f)};
  const LightTree tree(lights, Progress());
  EXPECT_GT(tree.probability({{1, 0, 0}}, 0), 0.95);
  EXPECT_LT(tree.probability({{9, 0, 0}}, 0), 0.05);
  EXPECT_NEAR(tree.probability({{5.05f, 0, 0}}, 0), 0.5, 1e-6);
}

TEST(LightTree, LightsBelowThePlaneAndThoseThatShineElsewhereAreUnlikely) {
  std::vector<LightTree::Light> lights(3, {{Vec3(-0.1f), Vec3(0.1f)}, 1});
  const LightCone down{{0, 0, -1}, 1, 0}, up{{0, 0, 1}, 1, 0};
  lights[0] = {{Vec3(0.9f, 0, 2), Vec3(1.1f, 0.2f, 2)}, 1, down};
  lights[1] = {{Vec3(-1.1f, 0, 2), Vec3(-0.9f, 0.2f, 2)}, 1, up};
  lights[2] = {{Vec3(0, 0, -2), Vec3(0.2f, 0.2f, -2)}, 1, up};
  const LightTree tree(lights, Progress());
  const LightPlace above{Vec3(0), {0, 0, 1}};
  EXPECT_GT(tree.probability(tree.cut(above), above, 0), 0.99);
  const LightPlace both{Vec3(0), {0, 0, 1}, true};
  EXPECT_GT(tree.probability(tree.cut(both), both, 2), 0.4);
}

/// A cut tells every one of a few lights apart; if they are small, its total is their irradiance.
TEST(LightTree, TheCutOfFewLightsIsTheirIrradiance) {
  const std::vector<LightTree::Light> lights = {{{Vec3(0, 0, 2), Vec3(0.01f, 0.01f, 2)}, 3, {{0, 0, -1}, 1, 0}},
                                                {{Vec3(3, 0, 4), Vec3(3.01f, 0, 4)}, 5}};
  const LightTree tree(lights, Progress());
  const LightPlace place{Vec3(0), {0, 0, 1}};
  EXPECT_NEAR(tree.cut(place).total(), 3.0 / 4 + 5.0 / 25 * 0.8, 0.01);
}

TEST(LightTree, LightsOfOnePointAreChosenByIntensity) {
  std::vector<LightTree::Light> lights(3, {{Vec3(1), Vec3(1)}, 1});
  lights[2].intensity = 6;
  const LightTree tree(lights, Progress());
  for (const Vec3& position : {Vec3(0), Vec3(1)}) EXPECT_NEAR(tree.probability({position}, 2), 0.75, 1e-6);
  EXPECT_EQ(tree.intensity(), 8);
  EXPECT_TRUE(LightTree().empty());
}

/// No light that a ray meets is missed, few others are looked at.
TEST(LightTree, RaysMeetTheBoxesOnTheirWay) {
  const auto lights = scattered(500);
  const LightTree tree(lights, Progress());
  RandomStream random(1, 2, 3);
  int looked_at = 0;
  for (uint32_t i = 0; i < lights.size(); ++i) {
    const Vec3 origin(20 * random.next() - 5, 10 * random.next() - 3, -3);
    const Vec3 target = glm::mix(lights[i].box.low, lights[i].box.high, random.next());
    bool met = false;
    tree.meet(origin, glm::normalize(target - origin), [&](uint32_t light) {
      met |= light == i;
      ++looked_at;
    });
    EXPECT_TRUE(met) << i;
  }
  EXPECT_LT(looked_at, 10 * static_cast<int>(lights.size()));
}

TEST(LightTree, IsNotBuiltAfterACancel) {
  Progress cancelled;
  cancelled.cancel();
  EXPECT_THROW(LightTree(scattered(1), cancelled), Error);
}

/// Building a tree of many lights takes seconds; a cancel during the build ends it early.
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
}  // namespace velour::light_tree_test
