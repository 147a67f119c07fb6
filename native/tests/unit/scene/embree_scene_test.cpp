// Rays against known geometry.
#include "scene/embree_scene.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

#include "base/error.h"
#include "math/sphere/random.h"
#include "math/sphere/warp.h"

namespace velour::embree_scene_test {
namespace {

const std::vector<Vec3> kCorners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
const std::vector<glm::uvec3> kTriangle = {{0, 1, 2}};

Affine scaled(const Vec3& scale, const Vec3& shift) {
  Affine a;
  for (int i = 0; i < 3; ++i) {
    a.m[5 * i] = scale[i];
    a.m[4 * i + 3] = shift[i];
  }
  return a;
}

TEST(EmbreeScene, SelfTestPassesAndInfoNamesAFile) {
  EXPECT_NO_THROW(embree_self_test());
  EXPECT_NE(embree_info().path.find("embree"), std::string::npos);
}

TEST(EmbreeScene, HitReportsDistanceBarycentricsAndFrontNormal) {
  EmbreeScene scene;
  scene.add_instance(scene.add_mesh(kCorners, kTriangle), {});
  scene.commit(1);
  Hit hit;
  scene.intersect({{0.5f, 0.25f, -3}, 0, {0, 0, 1}}, hit);
  ASSERT_EQ(hit.instance, 0u);
  EXPECT_FLOAT_EQ(hit.distance, 3);
  EXPECT_NEAR(hit.u, 0.5f, 1e-6f);
  EXPECT_NEAR(hit.v, 0.25f, 1e-6f);
  EXPECT_GT(hit.geometric_normal.z, 0);  // front side, although seen from the back
  scene.intersect({{0.5f, 0.25f, -3}, 0, {0, 0, 1}, 2.5f}, hit);
  EXPECT_EQ(hit.instance, kNoHit);
}

TEST(EmbreeScene, MirroredInstanceKeepsItsOutside) {
  EmbreeScene scene;
  const uint32_t mesh = scene.add_mesh(kCorners, kTriangle);
  scene.add_instance(mesh, {});
  const uint32_t mirrored = scene.add_instance(mesh, scaled({-2, 2, 2}, {0, 0, 5}));
  scene.commit(1);
  Hit hit;
  scene.intersect({{-0.5f, 0.5f, 9}, 0, {0, 0, -1}}, hit);
  ASSERT_EQ(hit.instance, mirrored);
  EXPECT_FLOAT_EQ(hit.distance, 4);
  EXPECT_GT(hit.geometric_normal.z, 0);
}

TEST(EmbreeScene, BatchesAgreeWithSingleRays) {
  EmbreeScene scene;
  std::vector<Vec3> positions;
  std::vector<glm::uvec3> triangles;
  RandomStream random(1, 2, 3);
  for (uint32_t i = 0; i < 30; ++i) {
    for (int k = 0; k < 3; ++k) positions.push_back({random.next(), random.next(), random.next()});
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  scene.add_instance(scene.add_mesh(positions, triangles), {});
  scene.commit(2);
  std::vector<Ray> rays;
  for (int i = 0; i < 1003; ++i) rays.push_back({{0.5f, 0.5f, 0.5f}, 0, sample_uniform_sphere(random.next2()), 0.3f});
  std::vector<uint8_t> blocked(rays.size());
  std::vector<Hit> hits(rays.size());
  scene.occluded(rays, blocked.data());
  scene.intersect(rays, hits.data());
  int blocked_count = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(blocked[i] != 0, scene.occluded(rays[i]));
    EXPECT_EQ(blocked[i] != 0, hits[i].instance != kNoHit);
    blocked_count += blocked[i];
  }
  EXPECT_GT(blocked_count, 100);
  EXPECT_LT(blocked_count, 1000);
  EXPECT_GT(scene.bytes(), 30u * 36u);
}

/// Meshes that are turned, mirrored and shared, in one level and in two.
TEST(EmbreeScene, OneLevelMeetsWhatTwoDo) {
  RandomStream random(4, 5, 6);
  EmbreeScene one, two;
  const auto add = [&](const Affine& place, bool is_new) {
    for (EmbreeScene* scene : {&one, &two}) {
      scene->add_instance(is_new ? scene->add_mesh(kCorners, kTriangle) : 0, place);
    }
  };
  for (int i = 0; i < 40; ++i) {
    const float side = i % 3 == 0 ? -1.0f : 1.0f;
    Affine place = scaled({side * (0.2f + random.next()), 1, 1}, {random.next(), random.next(), random.next()});
    for (float& m : place.m) m += 0.2f * random.next();
    add(place, i % 8 != 7);
  }
  one.commit(1, nullptr, EmbreeScene::Levels::one);
  two.commit(1);
  ASSERT_EQ(one.levels(), EmbreeScene::Levels::one);
  ASSERT_EQ(two.levels(), EmbreeScene::Levels::two);
  int met = 0;
  for (int i = 0; i < 500; ++i) {
    const Ray ray{{1.5f, 1.5f, 1.5f}, 0, sample_uniform_sphere(random.next2())};
    Hit a, b;
    one.intersect(ray, a);
    two.intersect(ray, b);
    ASSERT_EQ(a.instance, b.instance);
    if (a.instance == kNoHit) continue;
    ++met;
    EXPECT_NEAR(a.distance, b.distance, 1e-5f);
    EXPECT_NEAR(a.u, b.u, 1e-4f);
    EXPECT_LT(glm::distance(glm::normalize(a.geometric_normal), glm::normalize(b.geometric_normal)), 1e-5f);
  }
  EXPECT_GT(met, 50);
}

TEST(EmbreeScene, TakesTwoLevelsWhereMeshesRepeat) {
  EmbreeScene scene;
  const uint32_t mesh = scene.add_mesh(kCorners, kTriangle);
  for (int i = 0; i < 3; ++i) scene.add_instance(mesh, scaled(Vec3(1), {0, 0, static_cast<float>(i)}));
  scene.commit(1, nullptr, EmbreeScene::Levels::one);
  EXPECT_EQ(scene.levels(), EmbreeScene::Levels::two);
}

/// Renders of one committed scene do so for its emissive meshes, whose hierarchies the scene itself may not need.
TEST(EmbreeScene, ScenesThatShareMeshesMayBeCommittedAtOnce) {
  constexpr uint32_t kMeshes = 4, kScenes = 4;
  for (int round = 0; round < 20; ++round) {
    EmbreeScene base;
    for (uint32_t m = 0; m < kMeshes; ++m) {
      base.add_instance(base.add_mesh(kCorners, kTriangle), scaled(Vec3(1.0f), {2.0f * static_cast<float>(m), 0, 0}));
    }
    base.commit(1, nullptr, EmbreeScene::Levels::one);
    std::vector<std::unique_ptr<EmbreeScene>> scenes;
    std::vector<std::thread> threads;
    for (uint32_t k = 0; k < kScenes; ++k) {
      scenes.push_back(std::make_unique<EmbreeScene>());
      EmbreeScene& scene = *scenes.back();
      scene.share_meshes(base);
      for (uint32_t m = 0; m < kMeshes; ++m) {
        scene.add_instance(m, scaled(Vec3(1.0f), {2.0f * static_cast<float>(m), 0, 0}));
      }
    }
    for (const auto& scene : scenes) {
      threads.emplace_back([&scene] { scene->commit(1, nullptr, EmbreeScene::Levels::two); });
    }
    for (std::thread& thread : threads) thread.join();
    for (const auto& scene : scenes) {
      for (uint32_t m = 0; m < kMeshes; ++m) {
        Hit hit;
        scene->intersect({{0.25f + 2.0f * static_cast<float>(m), 0.25f, 1}, 0, {0, 0, -1}}, hit);
        EXPECT_EQ(hit.instance, m);
      }
    }
  }
}

TEST(EmbreeScene, CoherentBatchesAgreeWithSingleRays) {
  EmbreeScene scene;
  const uint32_t mesh = scene.add_mesh(kCorners, kTriangle);
  for (int i = 0; i < 20; ++i) {
    const auto at = static_cast<float>(i);
    scene.add_instance(mesh, scaled({1, 0.5f + 0.02f * at, 1}, {0.7f * at, 0, 0.1f * at}));
  }
  scene.commit(1);
  const Vec3 direction = glm::normalize(Vec3{0.3f, 0.2f, 1});
  std::vector<Ray> rays;
  for (int i = 0; i < 1003; ++i) {  // the last packet is not full, and some rays end before the next triangle
    rays.push_back({{0.0127f * static_cast<float>(i), 0.0f, -1}, 0, direction, i % 3 == 0 ? 2.0f : 10.0f});
  }
  std::vector<uint8_t> blocked(rays.size());
  scene.occluded_coherent(rays, blocked.data());
  int blocked_count = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(blocked[i] != 0, scene.occluded(rays[i])) << i;
    blocked_count += blocked[i];
  }
  EXPECT_GT(blocked_count, 100);
  EXPECT_LT(blocked_count, 900);
}

/// One instance, alone or beside a copy that is out of the rays' way, in one level and in two, still or moving.
TEST(EmbreeScene, RaysDoNotMeetInstancesHiddenFromTheirKind) {
  const Ray ray{{0.25f, 0.25f, 2}, 0, {0, 0, -1}};
  const std::vector<Ray> rays(100, ray);
  std::vector<uint8_t> kinds, blocked(rays.size());
  for (size_t i = 0; i < rays.size(); ++i) kinds.push_back(i % 3 == 0 ? 1 : i % 3 == 1 ? 4 : RayKinds::kAny);
  std::vector<Hit> hits(rays.size());
  for (int variant = 0; variant < 16; ++variant) {
    SCOPED_TRACE(variant);
    const bool is_hidden = (variant & 1) != 0, is_alone = (variant & 2) != 0, moves = (variant & 4) != 0;
    const auto levels = (variant & 8) != 0 ? EmbreeScene::Levels::one : EmbreeScene::Levels::two;
    EmbreeScene scene;
    const uint32_t mesh = scene.add_mesh(kCorners, kTriangle);
    const std::vector<Affine> steps(moves ? 2 : 0);
    scene.add_instance(mesh, {}, steps, is_hidden ? 1 | 2 : 0);
    if (!is_alone) scene.add_instance(scene.add_mesh(kCorners, kTriangle), scaled(Vec3(1), {9, 0, 0}));
    scene.commit(1, nullptr, levels);
    scene.intersect(rays, hits.data(), {.each = kinds});
    scene.occluded(rays, blocked.data(), {.each = kinds});
    for (size_t i = 0; i < rays.size(); ++i) {
      EXPECT_EQ(hits[i].instance, is_hidden && kinds[i] == 1 ? kNoHit : 0);
      EXPECT_EQ(blocked[i] != 0, hits[i].instance == 0);
    }
    scene.occluded(rays, blocked.data(), {2});
    EXPECT_EQ(blocked[0] != 0, !is_hidden);
    scene.occluded_coherent(rays, blocked.data());
    EXPECT_TRUE(blocked[0]);
    EXPECT_TRUE(scene.occluded(ray));
  }
}

TEST(EmbreeScene, RefusesIndicesOutsideTheMesh) {
  EmbreeScene scene;
  EXPECT_THROW(scene.add_mesh(kCorners, std::vector<glm::uvec3>{{0, 1, 3}}), Error);
  EXPECT_THROW(scene.add_instance(0, {}), Error);
}

TEST(EmbreeScene, EmptySceneMissesEverything) {
  EmbreeScene scene;
  scene.commit(1);
  EXPECT_FALSE(scene.occluded({{0, 0, 0}, 0, {0, 0, 1}}));
}

/// A hilly square of 2 x side x side triangles.
struct Hills {
  std::vector<Vec3> positions;
  std::vector<glm::uvec3> triangles;
  explicit Hills(uint32_t side);
};

Hills::Hills(uint32_t side) {
  for (uint32_t y = 0; y <= side; ++y) {
    for (uint32_t x = 0; x <= side; ++x) {
      const Vec2 p = Vec2(x, y) / static_cast<float>(side);
      positions.push_back({p, 0.05f * std::sin(40 * p.x) * std::sin(40 * p.y)});
      if (x == side || y == side) continue;
      const uint32_t a = y * (side + 1) + x, b = a + side + 1;
      triangles.insert(triangles.end(), {{a, a + 1, b + 1}, {a, b + 1, b}});
    }
  }
}

void add_hills(EmbreeScene& scene, uint32_t side) {
  const Hills hills(side);
  scene.add_instance(scene.add_mesh(hills.positions, hills.triangles), scaled(Vec3(1), {0, 0, 1}));
}

double seconds(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Whether rays from above meet the same of both.
void expect_same_hits(const EmbreeScene& one, const EmbreeScene& other) {
  RandomStream random(1, 2, 3);
  for (int i = 0; i < 1000; ++i) {
    const Ray ray{{random.next(), random.next(), 3}, 0, {0, 0, -1}};
    Hit a, b;
    one.intersect(ray, a);
    other.intersect(ray, b);
    ASSERT_EQ(a.triangle, b.triangle);
    ASSERT_EQ(a.distance, b.distance);
  }
}

void expect_cancelled(EmbreeScene& scene, const Progress& progress) {
  try {
    scene.commit(2, &progress);
    ADD_FAILURE() << "it was not cancelled";
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::cancelled);
  }
}

constexpr uint32_t kSide = 1000;

TEST(EmbreeScene, ACancelEndsTheWaitAndTheBuildGoesOn) {
  EmbreeScene whole, cancelled;
  add_hills(whole, kSide);
  const double needed = seconds([&] { whole.commit(2); });
  add_hills(cancelled, kSide);
  Progress progress;
  progress.cancel();
  EXPECT_LT(seconds([&] { expect_cancelled(cancelled, progress); }), needed / 4) << "a build takes " << needed << " s";
  std::this_thread::sleep_for(std::chrono::duration<double>(2 * needed));
  EXPECT_LT(seconds([&] { cancelled.commit(2); }), needed / 2) << "a build takes " << needed << " s";
  expect_same_hits(whole, cancelled);
}

TEST(EmbreeScene, AMeshThatGivesWayIsNotBuilt) {
  EmbreeScene small, changed;
  add_hills(small, 10);
  small.commit(2);
  add_hills(changed, kSide);
  Progress progress;
  progress.cancel();
  for (int i = 0; i < 5; ++i) {
    expect_cancelled(changed, progress);
    changed.set_mesh(0, kCorners, kTriangle);
  }
  const Hills hills(10);
  changed.set_mesh(0, hills.positions, hills.triangles);
  changed.commit(2);
  expect_same_hits(small, changed);
}

TEST(EmbreeScene, ASceneMayGoWhileItIsBuilt) {
  EmbreeScene scene;
  add_hills(scene, kSide);
  Progress progress;
  progress.cancel();
  expect_cancelled(scene, progress);
}

}  // namespace
}  // namespace velour::embree_scene_test
