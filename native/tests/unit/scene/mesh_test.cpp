// Meshes, cameras and the bookkeeping of the scene.
#include "scene/mesh.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/error.h"
#include "math/sphere/random.h"
#include "scene/scene.h"
#include "support/test_data.h"
#include "support/test_scene.h"

namespace velour::mesh_test {
namespace {

const std::vector<Vec3> kQuad = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};

TEST(Mesh, DropsTrianglesThatCannotBeHit) {
  std::vector<Vec3> positions = kQuad;
  positions.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0});
  positions.push_back({1e30f, 0, 0});
  const std::vector<glm::uvec3> triangles = {{0, 1, 2}, {0, 1, 4}, {0, 1, 1}, {0, 1, 5}, {0, 2, 3}};
  const std::vector<uint32_t> slots = {7, 0, 0, 0, 9};
  const Mesh mesh({.positions = positions, .triangles = triangles, .material_slots = slots});
  EXPECT_EQ(mesh.dropped(), 3u);
  ASSERT_EQ(mesh.triangles().size(), 2u);
  EXPECT_EQ(mesh.material_slot(1), 9u);  // what belongs to a triangle stays with it
  for (const Vec3& p : mesh.positions()) EXPECT_TRUE(std::isfinite(p.x));
}

TEST(Mesh, SmoothNormalsAreWeightedByArea) {
  // A large and a small triangle share the edge along y; the larger pulls the normals more.
  const std::vector<Vec3> p = {{0, 0, 0}, {0, 1, 0}, {-10, 0, 0}, {0, 0, -1}};
  const std::vector<glm::uvec3> t = {{0, 1, 2}, {1, 0, 3}};
  const Mesh smooth({.positions = p, .triangles = t});
  const Vec3 shared = glm::normalize(smooth.shading_normal(0, {0, 0}));
  EXPECT_NEAR(shared.x / shared.z, 0.1f, 1e-5f);
  const std::vector<uint8_t> flags = {1, 0};
  const Mesh mixed({.positions = p, .triangles = t, .smooth = flags});
  EXPECT_NEAR(glm::normalize(mixed.shading_normal(0, {0, 0})).x, shared.x, 1e-6f);
  EXPECT_NEAR(std::abs(mixed.shading_normal(1, {0.2f, 0.2f}).x), 1, 1e-6f);
}

TEST(Mesh, BadCornerNormalsGiveWayToTheTriangles) {
  const std::vector<glm::uvec3> t = {{0, 1, 2}};
  const std::vector<Vec3> n = {Vec3(0.0f), {NAN, 0, 0}, {0, 3, 0}};
  const Mesh mesh({.positions = kQuad, .triangles = t, .corner_normals = n});
  EXPECT_EQ(mesh.shading_normal(0, {0, 0}), Vec3(0, 0, 1));
  EXPECT_EQ(mesh.shading_normal(0, {1, 0}), Vec3(0, 0, 1));
  EXPECT_EQ(mesh.shading_normal(0, {0, 1}), Vec3(0, 1, 0));
}

TEST(Mesh, OpposedCornerNormalsDoNotVanish) {
  const std::vector<glm::uvec3> t = {{0, 1, 2}};
  const std::vector<Vec3> n = {{0, 0, 1}, {0, 0, -1}, {0, 0, 1}};
  const Mesh mesh({.positions = kQuad, .triangles = t, .corner_normals = n});
  EXPECT_EQ(glm::length(mesh.shading_normal(0, {0.5f, 0})), 1);
}

TEST(Mesh, TangentRunsAlongTheFirstTextureCoordinate) {
  const std::vector<glm::uvec3> t = {{0, 1, 2}};
  const std::vector<Vec2> uvs = {{0, 0}, {0, 1}, {-1, 1}};  // u runs along -y, v along +x
  const Mesh mesh({.positions = kQuad, .triangles = t, .corner_uvs = uvs});
  const Vec3 tangent = glm::normalize(mesh.tangent(0));
  EXPECT_NEAR(tangent.y, -1, 1e-6f);
  const std::vector<Vec2> same = {{0, 0}, {0, 0}, {0, 0}};
  EXPECT_EQ(Mesh({.positions = kQuad, .triangles = t, .corner_uvs = same}).tangent(0), Vec3(0.0f));
}

TEST(Mesh, RefusesWrongLengthsAndIndices) {
  const std::vector<glm::uvec3> t = {{0, 1, 2}}, outside = {{0, 1, 4}};
  const std::vector<Vec3> two(2);
  EXPECT_THROW(Mesh({.positions = kQuad, .triangles = outside}), Error);
  EXPECT_THROW(Mesh({.positions = kQuad, .triangles = t, .corner_normals = two}), Error);
}

TEST(Camera, LookAtPutsTheTargetInTheMiddleAndUpAbove) {
  const Camera camera = Camera::look_at({3, -4, 5}, {1, 1, 1}, {0, 0, 1}, 0.7f, 1.5f);
  const Ray middle = camera.ray({0.5f, 0.5f});
  EXPECT_NEAR(glm::length(middle.direction - glm::normalize(Vec3(-2, 5, -4))), 0, 1e-6f);
  EXPECT_GT(camera.ray({0.5f, 1}).direction.z, middle.direction.z);
  const Vec3 right = camera.ray({1, 0.5f}).direction;
  EXPECT_NEAR(right.z, middle.direction.z * glm::dot(right, middle.direction), 1e-5f);  // the horizon is level
  EXPECT_NEAR(camera.depth({1, 1, 1}), std::sqrt(45.0f), 1e-5f);
  const Camera down = Camera::look_at({0, 0, 5}, {0, 0, 0}, {0, 0, 1}, 0.7f, 1);  // along up: still a camera
  EXPECT_TRUE(down.camera_to_world.finite());
}

TEST(Camera, ClipPlanesLieAcrossTheLineOfSight) {
  Camera camera = test::camera_above(1);
  camera.clip_start = 1;
  camera.clip_end = 6;
  for (const Vec2& at : {Vec2(0.5f, 0.5f), Vec2(0, 1)}) {
    const Ray ray = camera.ray(at);
    EXPECT_NEAR(camera.depth(ray.origin + ray.near * ray.direction), 1, 1e-5f);
    EXPECT_NEAR(camera.depth(ray.origin + ray.far * ray.direction), 6, 1e-5f);
  }
}

TEST(Camera, FramingHoldsTheWholeBox) {
  for (const Vec3& size : {Vec3(1, 1, 1), Vec3(9, 1, 2), Vec3(1, 5, 9), Vec3(0, 0, 0)}) {
    for (int up_axis : {1, 2}) {
      Bounds bounds;
      bounds.add({1, 2, 3});
      bounds.add(Vec3(1, 2, 3) + size);
      const Camera camera = Camera::framing(bounds, 1.5f, up_axis);
      const Affine& map = camera.camera_to_world;
      ASSERT_TRUE(map.finite());
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3 p = bounds.low + size * Vec3(corner & 1, corner >> 1 & 1, corner >> 2);
        const Vec3 to = p - map.column(3);
        const float depth = camera.depth(p);
        EXPECT_LE(std::abs(glm::dot(to, map.column(0))), camera.window[1] * depth);
        EXPECT_LE(std::abs(glm::dot(to, map.column(1))), camera.window[3] * depth);
      }
    }
  }
}

TEST(Scene, SlotsChooseMaterialsAndRefuseMissingOnes) {
  Scene scene;
  const std::vector<glm::uvec3> t = {{0, 1, 2}, {0, 2, 3}};
  const std::vector<uint32_t> slots = {0, 5};
  const uint32_t mesh = scene.add_mesh(Mesh({.positions = kQuad, .triangles = t, .material_slots = slots}));
  const auto material = std::make_shared<test::Lambert>(0.5f);
  for (int i = 0; i < 3; ++i) scene.add_material({material, Rgb(0.0f), true});
  EXPECT_THROW(scene.add_instance(1, {}, {0}), Error);
  EXPECT_THROW(scene.add_instance(mesh, {}, {3}), Error);
  EXPECT_THROW(scene.add_instance(mesh, {}, {}), Error);
  scene.add_instance(mesh, {}, {2, 1});
  scene.commit(1);
  Hit hit;
  scene.rays().intersect({{0.7f, 0.2f, 1}, 0, {0, 0, -1}}, hit);
  EXPECT_EQ(scene.surface(hit).material, 2u);
  scene.rays().intersect({{0.2f, 0.7f, 1}, 0, {0, 0, -1}}, hit);
  EXPECT_EQ(scene.surface(hit).material, 1u);  // slot 5 is beyond the list: its last entry
}

TEST(Scene, SurfaceIsWhereTheRayHits) {
  Scene scene;
  const uint32_t mesh = scene.add_mesh(test::sphere(16));
  scene.add_material({std::make_shared<test::Lambert>(0.5f), Rgb(0.0f), true});
  Affine map = test::shift({100, -20, 3}, {-2, 0.5f, 1});
  map.m[1] = 0.3f;  // sheared and mirrored
  scene.add_instance(mesh, map, {0});
  scene.add_instance(mesh, {}, {0});
  scene.commit(1);
  const Ray ray{{100, -20, 30}, 0, glm::normalize(Vec3(0.01f, 0.01f, -1))};
  Hit hit;
  scene.rays().intersect(ray, hit);
  ASSERT_EQ(hit.instance, 0u);
  const SurfacePoint point = scene.surface(hit);
  EXPECT_LT(glm::length(point.position - (ray.origin + hit.distance * ray.direction)), 1e-4f);
  EXPECT_LT(point.error, 1e-4f);
  EXPECT_LT(glm::dot(point.geometric_normal, ray.direction), -0.5f);
  EXPECT_GT(glm::dot(point.shading_normal, point.geometric_normal), 0.95f);
}

TEST(Scene, BoundsAreThoseOfAllCorners) {
  RandomStream random(1, 0, 0);
  Scene scene;
  const std::vector<glm::uvec3> t = {{0, 1, 2}, {0, 2, 3}};
  const uint32_t mesh = scene.add_mesh(Mesh({.positions = kQuad, .triangles = t}));
  scene.add_material({std::make_shared<test::Lambert>(0.5f), Rgb(0.0f), true});
  Bounds expected;
  for (int i = 0; i < 500; ++i) {
    Affine map;
    for (float& number : map.m) number = random.next() - 0.5f;
    scene.add_instance(mesh, map, {0});
    for (const Vec3& p : kQuad) expected.add(map.point(p));
  }
  scene.commit(1);
  for (int k = 0; k < 3; ++k) {
    EXPECT_FLOAT_EQ(scene.bounds().low[k], expected.low[k]);
    EXPECT_FLOAT_EQ(scene.bounds().high[k], expected.high[k]);
  }
}

TEST(Scene, CountsWhatItHoldsAndWarns) {
  Scene scene;
  scene.commit(1);
  EXPECT_EQ(scene.info().warnings.size(), 1u);  // no light
  const std::vector<glm::uvec3> t = {{0, 1, 2}, {0, 0, 2}};
  const uint32_t mesh = scene.add_mesh(Mesh({.positions = kQuad, .triangles = t}));
  scene.add_material({std::make_shared<test::Lambert>(0.5f), Rgb(0.0f), true});
  scene.add_instance(mesh, {}, {0});
  scene.add_instance(mesh, test::shift({2, 0, 0}), {0});
  scene.add_instance(mesh, test::shift({0, 0, 0}, {0, 1, 1}), {0});
  scene.add_light({});
  EXPECT_FALSE(scene.committed());
  scene.commit(1);
  EXPECT_TRUE(scene.committed());
  EXPECT_EQ(scene.info().triangles, 2u);
  EXPECT_EQ(scene.info().instances, 2u);
  EXPECT_EQ(scene.info().lights, 1u);
  EXPECT_GT(scene.info().bytes, 100u);
  EXPECT_EQ(scene.info().warnings.size(), 2u);  // a triangle and an instance left out
  EXPECT_EQ(scene.bounds().high.x, 3);
  Light bad;
  bad.angle = NAN;
  EXPECT_THROW(scene.add_light(bad), Error);
}

}  // namespace
}  // namespace velour::mesh_test
