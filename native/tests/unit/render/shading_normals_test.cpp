// Interpolated normals on coarse meshes: light stays on the side of the surface that it comes from.
#include <gtest/gtest.h>

#include "material/principled/principled_material.h"
#include "render/path/vertex.h"
#include "support/test_scene.h"

namespace velour::shading_normals_test {
namespace {

constexpr float kAngle = 0.04f;  // diameter of the sun that has an extent
const Vec3 kSuns[] = {glm::normalize(Vec3(1, 0.3f, 0.2f)), glm::normalize(Vec3(-0.2f, 0.9f, 0.4f)),
                      glm::normalize(Vec3(0.3f, -0.5f, -0.8f)), glm::normalize(Vec3(0.1f, 0.2f, 1))};

/// A place of a sphere of few triangles, near one of its corners, where normals differ most.
struct Place {
  Vec3 position, normal, shading_normal;
};

std::vector<Place> places_on(const Mesh& sphere) {
  std::vector<Place> places;
  for (uint32_t t = 0; t < sphere.triangles().size(); ++t) {
    const glm::uvec3& corner = sphere.triangles()[t];
    const std::span<const Vec3> p = sphere.positions();
    const Vec3 normal = glm::normalize(glm::cross(p[corner.y] - p[corner.x], p[corner.z] - p[corner.x]));
    for (const Vec2& weights : {Vec2(0.02f, 0.02f), Vec2(0.96f, 0.02f), Vec2(0.02f, 0.96f)}) {
      places.push_back({sphere.position(t, weights), normal, glm::normalize(sphere.shading_normal(t, weights))});
    }
  }
  return places;
}

/// That its interpolated normal faces all of the sun, and the surface none of it.
bool would_leak(const Place& place, const Vec3& sun) {
  return glm::dot(place.normal, sun) < -kAngle && glm::dot(place.shading_normal, sun) > kAngle;
}

/// Nothing but the surface itself stops its light.
Light lamp(const Vec3& sun, float angle) {
  const Frame frame = Frame::about(sun);
  Light lamp;
  lamp.color = Rgb(1);
  lamp.angle = angle;
  lamp.casts_shadow = false;
  for (int i = 0; i < 3; ++i) {
    lamp.light_to_world.m[4 * i] = frame.x[i];
    lamp.light_to_world.m[4 * i + 1] = frame.y[i];
    lamp.light_to_world.m[4 * i + 2] = frame.z[i];
  }
  return lamp;
}

/// The brightest pixel of a picture of no more than that place.
float brightest(const Mesh& sphere, const Place& place, const Light& lamp, Strategy strategy) {
  Scene scene;
  const auto white = make_principled_material({.base_color = Rgb(1)});
  scene.add_instance(scene.add_mesh(sphere), Affine{}, {scene.add_material({.material = white})});
  scene.add_light(lamp);
  scene.set_camera(
      Camera::look_at(place.position + 0.1f * place.normal, place.position, Frame::about(place.normal).x, 0.02f, 1));
  scene.commit(1);
  const auto pixels = test::rendered(scene, test::small_options(strategy, 16));
  float most = 0;
  for (size_t i = 0; i < pixels.size(); i += 4) most = std::max(most, pixels[i]);
  return most;
}

TEST(ShadingNormals, LeakNoLightFromBelowACoarseSphere) {
  const Mesh sphere = test::sphere(4);
  int leaking = 0;
  for (const Vec3& sun : kSuns) {
    for (const Place& place : places_on(sphere)) {
      if (!would_leak(place, sun)) continue;
      ++leaking;
      for (const Strategy strategy : {Strategy::cosine, Strategy::light, Strategy::mis}) {
        EXPECT_EQ(brightest(sphere, place, lamp(sun, 0), strategy), 0);
        EXPECT_EQ(brightest(sphere, place, lamp(sun, kAngle), strategy), 0);
      }
    }
  }
  EXPECT_GT(leaking, 5);
}

/// The control: wherever the surface faces the sun there is light.
TEST(ShadingNormals, LetInLightFromAboveACoarseSphere) {
  const Mesh sphere = test::sphere(4);
  for (const Vec3& sun : kSuns) {
    int facing = 0;
    for (const Place& place : places_on(sphere)) {
      if (glm::dot(place.normal, sun) < 0.1f || glm::dot(place.shading_normal, sun) < 0.1f || ++facing % 4 != 0)
        continue;
      EXPECT_GT(brightest(sphere, place, lamp(sun, 0), Strategy::mis), 0.01f);
      EXPECT_GT(brightest(sphere, place, lamp(sun, kAngle), Strategy::mis), 0.01f);
    }
    EXPECT_GT(facing, 20);
  }
}

/// Normals of leaves may point behind their faces; only those of a file whose normals oppose its winding are turned.
TEST(ShadingNormals, TurnWithTheirFaces) {
  const Vec3 up(0, 0, 1), wv = glm::normalize(Vec3(1, 0, 0.3f));
  for (const float cosine : {0.2f, -0.2f, -0.49f, -0.51f, -1.0f}) {
    const Vec3 normal(std::sqrt(1 - cosine * cosine), 0, cosine);
    const Vec3 expected = cosine < -0.5f ? -normal : normal;
    const Vertex front({Vec3(0), up, normal, Vec3(0), 0, 0}, wv);
    const Vertex back({Vec3(0), -up, -normal, Vec3(0), 0, 0}, wv);
    EXPECT_EQ(front.frame.z, back.frame.z) << cosine;
    if (glm::dot(expected, wv) > 0.1f) {
      EXPECT_LT(glm::length(front.frame.z - expected), 1e-6f) << cosine;
    }
  }
}

/// By interpolated normals alone the places that would leak do.
TEST(ShadingNormals, AreNotWhatKeepsLightOut) {
  for (const Vec3& sun : kSuns) {
    for (const Place& place : places_on(test::sphere(4))) {
      if (!would_leak(place, sun)) continue;
      const SurfacePoint point{place.position, place.normal, place.shading_normal, Vec3(0), 0, 0};
      const Vertex vertex(point, place.normal);
      const Vec3 wl = vertex.frame.to_local(sun);
      EXPECT_GT(wl.z, 0);
      EXPECT_FALSE(vertex.receives(wl, sun));
    }
  }
}

}  // namespace
}  // namespace velour::shading_normals_test
