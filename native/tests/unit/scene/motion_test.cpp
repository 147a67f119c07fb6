// Motion: steps of transforms, times of the shutter, rays and meshes at a time.
#include "scene/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/error.h"
#include "math/sphere/random.h"
#include "scene/camera.h"
#include "scene/embree_scene.h"
#include "scene/mesh.h"
#include "support/significance.h"

namespace velour::motion_test {
namespace {

const std::vector<Vec3> kCorners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
const std::vector<glm::uvec3> kTriangle = {{0, 1, 2}};

Affine shifted(const Vec3& by) {
  Affine map;
  for (int i = 0; i < 3; ++i) map.m[4 * i + 3] = by[i];
  return map;
}

/// Turned about z, then stretched along x before that.
Affine turned(float angle, float stretch = 1) {
  Affine map;
  map.m[0] = stretch * std::cos(angle);
  map.m[4] = stretch * std::sin(angle);
  map.m[1] = -std::sin(angle);
  map.m[5] = std::cos(angle);
  return map;
}

void expect_near(const Affine& found, const Affine& expected, float slack) {
  for (int i = 0; i < 12; ++i) EXPECT_NEAR(found.m[i], expected.m[i], slack) << i;
}

TEST(Motion, RotationsTurnEvenlyAndStretchIsLinear) {
  const std::vector<Affine> keys = {turned(0), turned(1, 2), turned(2.5f, 2)};
  const std::vector<Affine> steps = motion_steps(keys);
  EXPECT_LE(steps.size(), kMaxMotionSteps);
  // A chord of kMaxTurn is up to its square / 8 inside the arc.
  const auto slack = static_cast<float>(kMaxTurn * kMaxTurn / 4);
  expect_near(interpolated(steps, 0), keys[0], 0);
  expect_near(interpolated(steps, 0.5f), keys[1], 1e-6f);
  expect_near(interpolated(steps, 1), keys[2], 0);
  for (const float t : {0.1f, 0.37f, 0.9f}) expect_near(interpolated(steps, t / 2), turned(t, 1 + t), 2 * slack);
  expect_near(interpolated(steps, 0.75f), turned(1.75f, 2), 2 * slack);
  EXPECT_GT(std::abs(interpolated(keys, 0.75f).m[4] - turned(1.75f, 2).m[4]), 0.5f);  // the control: straight lines
}

TEST(Motion, WhatStaysHasNoStepsAndWhatOnlyMovesKeepsItsKeys) {
  EXPECT_TRUE(motion_steps(std::vector<Affine>(3, turned(1))).empty());
  const std::vector<Affine> keys = {shifted({0, 0, 0}), shifted({1, 0, 0}), shifted({3, 1, 0})};
  EXPECT_EQ(motion_steps(keys), keys);
  std::vector<Affine> flat = {turned(0), turned(2)};
  flat[1].m[10] = 0;
  EXPECT_EQ(motion_steps(flat), flat);
}

TEST(Motion, AMirroredStretchTurnsAsAWhole) {
  Affine one = turned(0), other = turned(0.5f);
  one.m[10] = other.m[10] = -1;
  const std::vector<Affine> keys = {one, other};
  Affine middle = turned(0.25f);
  middle.m[10] = -1;
  expect_near(interpolated(motion_steps(keys), 0.5f), middle, 1e-3f);
}

/// p-value of times against the density of a shutter, in even cells.
double p_of_times(const Shutter& sampled, const Shutter& claimed) {
  constexpr int kCells = 40, kTimes = 40000, kParts = 64;
  double observed[kCells] = {}, expected[kCells] = {}, mass = 0;
  RandomStream random(7, 0, 0);
  for (int i = 0; i < kTimes; ++i) {
    const float time = sampled.time(random.next());
    EXPECT_TRUE(time >= 0 && time <= 1);
    ++observed[std::min(static_cast<int>(time * kCells), kCells - 1)];
  }
  for (int i = 0; i < kCells * kParts; ++i) {
    const auto at = (static_cast<float>(i) + 0.5f) / (kCells * kParts);
    const double part = static_cast<double>(claimed.density(at)) / (kCells * kParts);
    expected[i / kParts] += kTimes * part;
    mass += part;
  }
  EXPECT_NEAR(mass, 1, 1e-3);
  double statistic = 0, few_observed = 0, few_expected = 1;  // cells where the shutter is nearly closed are pooled
  int cells = 1;
  const auto add = [&](double found, double wanted) { statistic += (found - wanted) * (found - wanted) / wanted; };
  for (int i = 0; i < kCells; ++i) {
    if (expected[i] < 5) {
      few_observed += observed[i];
      few_expected += expected[i];
    } else {
      add(observed[i], expected[i]);
      ++cells;
    }
  }
  add(few_observed, few_expected);
  return test::chi_square_tail(statistic, cells - 1);
}

TEST(Shutter, TimesFollowTheCurve) {
  std::vector<float> bell;
  for (int i = 0; i < 256; ++i) bell.push_back(1 - std::cos(2 * kPi * static_cast<float>(i) / 255));
  const Shutter even, ramp({0, 1}), gaps({0, 2, 0, 0, 0, 1, 1}), smooth(bell);
  const double level = test::sidak_level(0.01, 4);
  for (const Shutter* shutter : {&even, &ramp, &gaps, &smooth}) EXPECT_GT(p_of_times(*shutter, *shutter), level);
  EXPECT_LT(p_of_times(even, smooth), 1e-9);
  EXPECT_LT(p_of_times(ramp, Shutter({1, 0})), 1e-9);
}

TEST(Shutter, TimesGrowWithTheNumber) {
  const Shutter gaps({0, 2, 0, 0, 0, 1, 1});
  float before = -1;
  for (int i = 0; i < 4096; ++i) {
    const float time = gaps.time(static_cast<float>(i) / 4096);
    EXPECT_GE(time, before);
    before = time;
  }
  EXPECT_LE(gaps.time(0x1.fffffep-1f), 1);
}

std::string refusal(const std::vector<float>& curve) {
  try {
    const Shutter shutter(curve);
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::invalid_argument);
    return error.what();
  }
  return "";
}

TEST(Shutter, RefusesCurvesThatNeverOpenOrAreNotNumbers) {
  EXPECT_NE(refusal({0, 0}).find("never opens"), std::string::npos);
  EXPECT_NE(refusal({1, -1}).find("-1"), std::string::npos);
  EXPECT_NE(refusal({1, std::nanf("")}).find("nan"), std::string::npos);
  EXPECT_NE(refusal({}).find("never opens"), std::string::npos);
}

Hit hit_at(const EmbreeScene& scene, const Vec3& origin, float time) {
  Hit hit;
  scene.intersect({origin, 0, {0, 0, -1}, std::numeric_limits<float>::infinity(), time}, hit);
  const Ray ray{origin, 0, {0, 0, -1}, std::numeric_limits<float>::infinity(), time};
  uint8_t blocked[2];
  scene.occluded({&ray, 1}, blocked);
  scene.occluded_coherent({&ray, 1}, blocked + 1);
  for (const uint8_t b : blocked) EXPECT_EQ(b != 0, hit.instance != kNoHit) << time;
  return hit;
}

TEST(MovingRays, MeetAnInstanceWhereItIsAtTheirTime) {
  for (const auto levels : {EmbreeScene::Levels::one, EmbreeScene::Levels::two}) {
    EmbreeScene scene;
    const uint32_t mesh = scene.add_mesh(kCorners, kTriangle);
    const std::vector<Affine> steps = {shifted({-2, 0, 0}), shifted({0, 0, 0}), shifted({0, 0, 2})};
    scene.add_instance(mesh, steps[1], steps);
    scene.add_instance(scene.add_mesh(kCorners, kTriangle), shifted({0, 0, -5}));  // stays
    scene.commit(1, nullptr, levels);
    const Vec3 above(0.25f, 0.25f, 9);
    EXPECT_EQ(hit_at(scene, above, 0).instance, 1u);
    EXPECT_FLOAT_EQ(hit_at(scene, above, 0).distance, 14);
    EXPECT_FLOAT_EQ(hit_at(scene, above, 0.5f).distance, 9);
    const Hit later = hit_at(scene, above, 0.75f);
    EXPECT_EQ(later.instance, 0u);
    EXPECT_EQ(later.time, 0.75f);
    EXPECT_NEAR(later.distance, 8, 1e-5f);
    EXPECT_GT(later.geometric_normal.z, 0);
    EXPECT_EQ(hit_at(scene, {-1.25f, 0.25f, 9}, 0.25f).instance, kNoHit);
    EXPECT_EQ(hit_at(scene, {-0.75f, 0.25f, 9}, 0.25f).instance, 0u);
    EXPECT_EQ(hit_at(scene, {-0.75f, 0.25f, 9}, 0.5f).instance, kNoHit);
  }
}

TEST(MovingRays, MeetAMeshThatDeformsAndMoves) {
  std::vector<Vec3> shapes = kCorners;
  for (const Vec3& p : kCorners) shapes.push_back(p + Vec3(0, 0, 2 * p.x));  // its far corner rises
  for (const auto levels : {EmbreeScene::Levels::one, EmbreeScene::Levels::two}) {
    EmbreeScene scene;
    const uint32_t mesh = scene.add_mesh(shapes, kTriangle, 2);
    scene.add_instance(mesh, shifted({0, 0, 1}));
    const std::vector<Affine> steps = {shifted({3, 0, 0}), shifted({3, 0, 4})};
    scene.add_instance(scene.add_mesh(shapes, kTriangle, 2), shifted({3, 0, 2}), steps);
    scene.commit(1, nullptr, levels);
    for (const float time : {0.0f, 0.25f, 0.5f, 1.0f}) {
      const float rise = 2 * 0.5f * time;
      const Hit hit = hit_at(scene, {0.5f, 0.25f, 9}, time);
      EXPECT_NEAR(hit.distance, 8 - rise, 1e-5f) << time;
      const Vec3 normal = glm::normalize(hit.geometric_normal), expected = glm::normalize(Vec3(-2 * time, 0, 1));
      EXPECT_NEAR(glm::dot(normal, expected), 1, 1e-6f) << time;
      EXPECT_NEAR(hit_at(scene, {3.5f, 0.25f, 9}, time).distance, 9 - rise - 4 * time, 1e-5f) << time;
    }
  }
}

TEST(MovingMesh, HasShapesAndNormalsOfItsSteps) {
  std::vector<Vec3> shapes;
  for (const float rise : {0.0f, 1.0f, 4.0f}) {
    for (const Vec3& p : kCorners) shapes.push_back(p + Vec3(0, 0, rise * p.x));
  }
  const std::vector<Vec3> middle(shapes.begin() + 3, shapes.begin() + 6);
  const std::vector<uint8_t> not_smooth = {0};
  const Mesh flat(
      {.positions = middle, .triangles = kTriangle, .smooth = not_smooth, .steps = 3, .moved_positions = shapes});
  ASSERT_TRUE(flat.deforms());
  EXPECT_EQ(flat.position(0, {1, 0}), Vec3(1, 0, 1));
  EXPECT_EQ(flat.position(0, {1, 0}, 0.75f), Vec3(1, 0, 2.5f));
  EXPECT_EQ(flat.bounds().high.z, 4);
  // A flat triangle has the normal of its corners at that time, not a mean of normals.
  const Vec3 exact = glm::normalize(Vec3(-2.5f, 0, 1));
  EXPECT_NEAR(glm::dot(glm::normalize(flat.shading_normal(0, {0.2f, 0.2f}, 0.75f)), exact), 1, 1e-6f);
  const std::vector<Vec3> given = {{0, 0, 1}, {0, 0, 1}, {0, 0.6f, 0.8f}},
                          tilted = {{0, 0, 1}, {1, 0, 0}, {0, 0.6f, 0.8f}};
  std::vector<Vec3> normals = given;
  normals.insert(normals.end(), given.begin(), given.end());
  normals.insert(normals.end(), tilted.begin(), tilted.end());
  const Mesh smooth({.positions = middle,
                     .triangles = kTriangle,
                     .vertex_normals = given,
                     .steps = 3,
                     .moved_positions = shapes,
                     .moved_vertex_normals = normals});
  EXPECT_NEAR(glm::dot(smooth.corner_normals(0, 0.75f)[1], glm::normalize(Vec3(1, 0, 1))), 1, 1e-6f);
  EXPECT_NEAR(glm::dot(smooth.corner_normals(0, 0.25f)[2], given[2]), 1, 1e-6f);
  EXPECT_NEAR(glm::dot(smooth.corner_normals(0, 0)[0], given[0]), 1, 1e-6f);  // not the triangle's own
}

TEST(MovingMesh, LiftsEveryShape) {
  std::vector<Vec3> shapes = kCorners;
  for (const Vec3& p : kCorners) shapes.push_back(p + Vec3(0, 0, 3));
  const Mesh mesh({.positions = kCorners, .triangles = kTriangle, .steps = 2, .moved_positions = shapes});
  const ShellHeights height{-0.25f, 0.5f};
  const Mesh top = mesh.lifted({&height, 1}, Mat3(1.0f));
  EXPECT_EQ(top.steps(), 2u);
  EXPECT_NEAR(top.position(0, {0.3f, 0.3f}, 0).z, 0.5f, 1e-6f);
  EXPECT_NEAR(top.position(0, {0.3f, 0.3f}, 1).z, 3.5f, 1e-6f);
  ASSERT_TRUE(top.has_sides());
  float low = 9;
  for (const Vec3& p : top.corners(top.first_side(), 1)) low = std::min(low, p.z);
  EXPECT_NEAR(low, 2.75f, 1e-6f);
  EXPECT_EQ(top.corner_normals(top.first_side(), 1)[0], Vec3(0, 0, 1));
}

std::string mesh_refusal(uint32_t steps, size_t positions) {
  const std::vector<Vec3> moved(positions);
  try {
    const Mesh mesh({.positions = kCorners, .triangles = kTriangle, .steps = steps, .moved_positions = moved});
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(MovingMesh, RefusesShapesThatDoNotFit) {
  EXPECT_EQ(mesh_refusal(2, 6), "");
  EXPECT_NE(mesh_refusal(2, 5).find("5 moved positions"), std::string::npos);
  EXPECT_NE(mesh_refusal(1, 3).find("1 steps"), std::string::npos);
  EXPECT_NE(mesh_refusal(130, 390).find("130 steps"), std::string::npos);
}

TEST(MovingCamera, ShowsPointsWhereItsRaysGo) {
  Camera camera = Camera::look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 0.8f, 1.5f);
  Affine end = camera.camera_to_world;
  end.m[3] = 2;
  const std::vector<Affine> keys = {camera.camera_to_world, end};
  camera.steps = motion_steps(keys);
  camera.windows = {{-0.5f, 0.5f, -0.4f, 0.4f}, {-0.25f, 0.25f, -0.2f, 0.2f}};
  for (const auto type : {Camera::Type::perspective, Camera::Type::orthographic}) {
    camera.type = type;
    for (const float time : {0.0f, 0.3f, 1.0f}) {
      const Vec2 place(0.2f, 0.7f);
      const Ray ray = camera.ray(place, Vec2(0.0f), time);
      EXPECT_EQ(ray.time, time);
      const Vec2 found = CameraProjection(camera, time).picture(ray.origin + 3.0f * ray.direction);
      EXPECT_NEAR(found.x, place.x, 1e-5f);
      EXPECT_NEAR(found.y, place.y, 1e-5f);
    }
  }
  EXPECT_NEAR(camera.ray({0.5f, 0.5f}, Vec2(0.0f), 0.5f).origin.x, 1, 1e-6f);
}

}  // namespace
}  // namespace velour::motion_test
