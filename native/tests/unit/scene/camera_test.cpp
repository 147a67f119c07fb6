// Cameras: where rays start, and that a lens brings them together where it is focused.
#include "scene/camera.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "base/error.h"
#include "math/sphere/random.h"
#include "scene/scene.h"

namespace velour::camera_test {
namespace {

Camera with_lens(Camera::Type type) {
  Camera camera;
  camera.type = type;
  camera.clip_start = 0.5f;
  camera.clip_end = 8;
  camera.aperture = {.radius = 0.3f, .focus = 4};
  return camera;
}

Vec3 at_depth(const Ray& ray, float depth) {
  return ray.origin + (depth / -ray.direction.z) * ray.direction;  // the camera stands at the origin
}

TEST(Camera, RaysOfAPixelMeetInThePlaneInFocus) {
  for (const auto type : {Camera::Type::perspective, Camera::Type::orthographic}) {
    const Camera camera = with_lens(type);
    const Vec2 picture(0.8f, 0.3f);
    const Vec3 sharp = at_depth(camera.ray(picture), 4);
    for (const Vec2 lens : {Vec2(0.3f, 0), Vec2(-0.1f, 0.2f), Vec2(0, -0.3f)}) {
      const Ray ray = camera.ray(picture, lens);
      EXPECT_NEAR(glm::length(at_depth(ray, 4) - sharp), 0, 1e-5f);
      EXPECT_NEAR(glm::length(at_depth(ray, 2) - at_depth(camera.ray(picture), 2)), 0.5f * glm::length(lens), 1e-5f);
      // Clipped by planes, wherever on the lens.
      EXPECT_NEAR(-(ray.origin + ray.near * ray.direction).z, 0.5f, 1e-5f);
      EXPECT_NEAR(-(ray.origin + ray.far * ray.direction).z, 8, 1e-4f);
    }
  }
}

TEST(Camera, WithoutRaysIsRefused) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();
  Scene scene;
  const Camera usual = with_lens(Camera::Type::perspective);
  scene.set_camera(usual);
  const auto refused = [&](auto change, const char* named) {
    Camera camera = usual;
    change(camera);
    try {
      scene.set_camera(camera);
      ADD_FAILURE() << named;
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), Status::invalid_argument);
      EXPECT_NE(std::string(error.what()).find(named), std::string::npos) << error.what();
    }
  };
  for (const float broken : {kNan, kInfinity, -kInfinity, usual.window[0]}) {
    refused([&](Camera& c) { c.window[1] = broken; }, "window");
    refused([&](Camera& c) { c.windows = {{-1, 1, -1, 1}, {usual.window[0], broken, -1, 1}}; }, "window");
  }
  refused([&](Camera& c) { c.camera_to_world.m[3] = kNan; }, "transform");
  refused([&](Camera& c) { c.camera_to_world.m[0] = 0; }, "transform");
  refused([&](Camera& c) { c.steps.assign(2, Affine{{1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0}}); }, "transform");
  for (const float broken : {kNan, kInfinity, -1.0f}) {
    refused([&](Camera& c) { c.aperture.radius = broken; }, "aperture");
    refused([&](Camera& c) { c.aperture.focus = broken; }, "focus");
    refused([&](Camera& c) { c.aperture.ratio = broken; }, "ratio");
  }
  refused([&](Camera& c) { c.aperture.focus = 0; }, "focus");
  refused([&](Camera& c) { c.aperture.rotation = kNan; }, "rotation");
  refused([&](Camera& c) { c.clip_start = kNan; }, "clip");
  refused([&](Camera& c) { c.clip_end = kNan; }, "clip");
  Camera mirrored = usual;  // a flipped picture, sheared axes and no far end are fine
  std::swap(mirrored.window[0], mirrored.window[1]);
  mirrored.camera_to_world.m[1] = 0.5f;
  mirrored.clip_end = kInfinity;
  EXPECT_NO_THROW(scene.set_camera(mirrored));
}

/// Mean of x^2 and y^2, and of the share of places farther out than `radius`.
struct Spread {
  double xx = 0, yy = 0, outside = 0;
};

Spread spread_of(const Aperture& aperture, float radius) {
  Spread spread;
  RandomStream random(1, 2, 3);
  constexpr int kPlaces = 200000;
  for (int i = 0; i < kPlaces; ++i) {
    const Vec2 place = aperture.sample(random.next2());
    spread.xx += static_cast<double>(place.x * place.x) / kPlaces;
    spread.yy += static_cast<double>(place.y * place.y) / kPlaces;
    spread.outside += glm::length(place) > radius ? 1.0 / kPlaces : 0.0;
  }
  return spread;
}

TEST(Aperture, IsUniformOverItsShape) {
  struct Case {
    int blades;
    double second_moment;  // of the unit circle's polygon, along any axis
  };
  for (const Case c : {Case{0, 1.0 / 4}, Case{3, 1.0 / 8}, Case{4, 1.0 / 6}}) {
    for (const float rotation : {0.0f, 0.7f}) {
      const Spread spread = spread_of({.radius = 2, .blades = c.blades, .rotation = rotation, .ratio = 4}, 2.001f);
      EXPECT_NEAR(spread.xx, 4 * c.second_moment / 16, 0.002) << c.blades;
      EXPECT_NEAR(spread.yy, 4 * c.second_moment, 0.01) << c.blades;
      EXPECT_EQ(spread.outside, 0) << c.blades;
    }
  }
}

TEST(Aperture, CornersOfThePolygonFollowItsRotation) {
  // A triangle that points up reaches the unit circle at the top, and half as far at the bottom.
  const Aperture triangle{.radius = 1, .blades = 3, .rotation = 0.5f * kPi + kPi / 3};
  float top = 0, bottom = 0;
  RandomStream random(4, 5, 6);
  for (int i = 0; i < 20000; ++i) {
    const Vec2 place = triangle.sample(random.next2());
    top = std::max(top, place.y);
    bottom = std::min(bottom, place.y);
  }
  EXPECT_NEAR(top, 1, 0.02f);
  EXPECT_NEAR(bottom, -0.5f, 0.01f);
}

}  // namespace
}  // namespace velour::camera_test
