#include "render/path/vertex.h"

#include <gtest/gtest.h>

#include <optional>

#include "support/textured_scenes.h"

namespace velour::footprint_test {
namespace {

constexpr int kSide = 4096;  // pixels: neighbors mostly meet one triangle

Scene one_object(Mesh mesh, const Affine& place, const Camera& camera, bool varies = true) {
  Scene scene;
  const uint32_t material = varies ? scene.add_material({std::make_shared<test::Varying>(0.5f), Rgb(0.0f), false})
                                   : scene.add_material({std::make_shared<test::Lambert>(0.5f), Rgb(0.0f), false});
  scene.add_instance(scene.add_mesh(std::move(mesh)), place, {material});
  scene.set_camera(camera);
  scene.commit(1);
  return scene;
}

Hit hit_of(const Scene& scene, const Ray& ray) {
  Hit hit;
  scene.rays().intersect(ray, hit);
  return hit;
}

std::optional<Vertex> vertex_at(const Scene& scene, const Vec2& picture, int camera_rays = 1) {
  const Ray ray = scene.camera().ray(picture);
  const Hit hit = hit_of(scene, ray);
  if (hit.instance == kNoHit) return std::nullopt;
  const PixelFootprint pixel(scene, kSide, kSide, camera_rays);
  return Vertex(scene, scene.surface(hit), ray, hit, pixel.cone(ray.direction), &pixel);
}

/// Texture coordinates that a ray of the picture meets on `triangle`; nothing on others.
std::optional<Vec2> uv_at(const Scene& scene, const Vec2& picture, uint32_t triangle) {
  const Hit hit = hit_of(scene, scene.camera().ray(picture));
  if (hit.instance == kNoHit || hit.triangle != triangle) return std::nullopt;
  return scene.texture(hit).uv;
}

/// How far the ray's texture coordinates move from four pixels before `picture` to four after, in eighths.
std::optional<Vec2> difference(const Scene& scene, const Vec2& picture, const Vec2& axis) {
  const uint32_t triangle = hit_of(scene, scene.camera().ray(picture)).triangle;
  const Vec2 step = 4.0f / kSide * axis;
  const auto before = uv_at(scene, picture - step, triangle), after = uv_at(scene, picture + step, triangle);
  if (!before || !after) return std::nullopt;
  return (*after - *before) / 8.0f;
}

/// Compares footprints all over the picture with differences of rays; returns how many were compared.
int compare_with_differences(const Scene& scene, float tolerance) {
  int compared = 0;
  for (int i = 0; i < 400; ++i) {
    const Vec2 picture((static_cast<float>(i % 20) + 0.37f) / 20, (static_cast<float>(i / 20) + 0.59f) / 20);
    const auto vertex = vertex_at(scene, picture);
    if (!vertex) continue;
    const auto x = difference(scene, picture, {1, 0}), y = difference(scene, picture, {0, 1});
    if (!x || !y) continue;
    ++compared;
    const float size = glm::length(*x) + glm::length(*y);
    EXPECT_LT(glm::length(vertex->site.footprint[0] - *x), tolerance * size) << picture.x << ' ' << picture.y;
    EXPECT_LT(glm::length(vertex->site.footprint[1] - *y), tolerance * size) << picture.x << ' ' << picture.y;
  }
  return compared;
}

Camera tilted_camera() { return Camera::look_at({1, -4, 3}, {0, 0, 0}, {0, 0, 1}, 0.6f, 1); }

Camera orthographic_camera() {
  Camera camera = tilted_camera();
  camera.type = Camera::Type::orthographic;
  for (float& w : camera.window) w *= 4;
  return camera;
}

/// Turned, sheared, stretched and mirrored.
Affine crooked() { return {{-1.1f, 0.4f, 0, 0.1f, 0.2f, 0.7f, 0.3f, -0.2f, 0.1f, -0.5f, 1.3f, 0.05f}}; }

const Mat2 kSkewed(3.0f, 0.5f, -0.8f, 2.0f);

TEST(Footprint, IsWhatNeighboringPixelsMeetOnAPlane) {
  EXPECT_GT(compare_with_differences(one_object(test::textured_square(3, kSkewed), {}, tilted_camera()), 2e-3f), 300);
}

TEST(Footprint, IsWhatNeighboringPixelsMeetOnASphere) {
  EXPECT_GT(compare_with_differences(one_object(test::textured_sphere(6), {}, tilted_camera()), 5e-3f), 100);
}

TEST(Footprint, FollowsAnyTransform) {
  EXPECT_GT(compare_with_differences(one_object(test::textured_square(3, kSkewed), crooked(), tilted_camera()), 2e-3f),
            150);
  EXPECT_GT(compare_with_differences(one_object(test::textured_sphere(6), crooked(), tilted_camera()), 5e-3f), 60);
}

TEST(Footprint, OfOrthographicCameras) {
  EXPECT_GT(compare_with_differences(one_object(test::textured_square(3, kSkewed), {}, orthographic_camera()), 2e-3f),
            300);
  EXPECT_GT(compare_with_differences(one_object(test::textured_sphere(6), {}, orthographic_camera()), 5e-3f), 100);
}

/// A plane seen at `slope`, the cosine to its normal.
float length_at(float slope) {
  const Vec3 eye(0, -5 * std::sqrt(1 - slope * slope), 5 * slope);
  const Scene scene =
      one_object(test::textured_square(0.5f, Mat2(1)), {}, Camera::look_at(eye, Vec3(0), {0, 0, 1}, 0.5f, 1));
  return glm::length(vertex_at(scene, Vec2(0.5f))->site.footprint[1]);
}

TEST(Footprint, GrowsTowardsGrazingAnglesAndStaysFinite) {
  const float pixel = 2 * 5 * std::tan(0.25f) / kSide;
  EXPECT_NEAR(length_at(1), pixel, 1e-3f * pixel);
  EXPECT_NEAR(length_at(0.1f), 10 * pixel, 0.01f * pixel);
  EXPECT_NEAR(length_at(0.01f), 100 * pixel, 0.5f * pixel);
  EXPECT_NEAR(length_at(1e-4f), 1000 * pixel, 10 * pixel);  // kMinSlope; the true one is ten times as long
}

TEST(Footprint, ShrinksWithTheCameraRaysOfAPixel) {
  const Scene scene = one_object(test::textured_square(3, kSkewed), {}, tilted_camera());
  const Mat2 whole = vertex_at(scene, Vec2(0.4f))->site.footprint;
  for (const auto& [rays, part] : {std::pair{4, 0.5f}, {16, 0.25f}, {64, 0.125f}, {100000, 0.125f}}) {
    const Mat2 footprint = vertex_at(scene, Vec2(0.4f), rays)->site.footprint;
    EXPECT_NEAR(glm::distance(footprint[0], part * whole[0]), 0, 1e-5f * glm::length(whole[0])) << rays;
    EXPECT_NEAR(glm::distance(footprint[1], part * whole[1]), 0, 1e-5f * glm::length(whole[1])) << rays;
  }
}

TEST(Footprint, IsEmptyWithoutTextureCoordinates) {
  const Scene scene = one_object(test::square(3), {}, tilted_camera());
  const auto vertex = vertex_at(scene, Vec2(0.5f));
  EXPECT_EQ(vertex->site.uv, Vec2(0));
  EXPECT_EQ(vertex->site.footprint, Mat2(0.0f));
}

TEST(Footprint, IgnoresTextureCoordinatesThatAreNotFinite) {
  const Scene scene =
      one_object(test::textured_square(3, Mat2(std::numeric_limits<float>::infinity())), {}, tilted_camera());
  const auto vertex = vertex_at(scene, Vec2(0.5f, 0.45f));
  EXPECT_EQ(vertex->site.uv, Vec2(0));
  EXPECT_EQ(vertex->site.footprint, Mat2(0.0f));
}

TEST(Footprint, OfTinyTrianglesIsRight) {
  constexpr float kTiny = 1e-12f;
  Camera camera = test::camera_above(1);
  const Scene scene =
      one_object(test::textured_square(1, kSkewed), test::shift(Vec3(0), Vec3(kTiny, kTiny, 1)), camera);
  const TexturePoint point =
      scene.texture({.distance = 1, .geometric_normal = {0, 0, 1}, .u = 0.2f, .v = 0.3f, .triangle = 0, .instance = 0});
  EXPECT_NEAR(point.u_gradient.x * kTiny, kSkewed[0][0], 1e-5f);
  EXPECT_NEAR(point.u_gradient.y * kTiny, kSkewed[1][0], 1e-5f);
  EXPECT_NEAR(point.v_gradient.x * kTiny, kSkewed[0][1], 1e-5f);
  EXPECT_NEAR(point.v_gradient.y * kTiny, kSkewed[1][1], 1e-5f);
}

/// Area of a pixel at distance 1 along the cone, against its share of the sphere.
TEST(RayCone, IsAsWideAsThePixelsSolidAngle) {
  const Camera camera = Camera::look_at({1, 2, 3}, {0, 0, 0}, {0, 0, 1}, 2.0f, 1);
  const Scene scene = one_object(test::square(1), {}, camera);
  const PixelFootprint pixel(scene, kSide, kSide, 1);
  for (const Vec2& picture : {Vec2(0.5f), Vec2(0.1f, 0.6f), Vec2(0.02f, 0.97f)}) {
    const auto towards = [&](float x, float y) {
      return camera.ray(picture + Vec2(x, y) / static_cast<float>(kSide)).direction;
    };
    const Vec3 x = (towards(8, 0) - towards(-8, 0)) / 16.0f, y = (towards(0, 8) - towards(0, -8)) / 16.0f;
    const float solid_angle = glm::length(glm::cross(x, y));
    const RayCone cone = pixel.cone(towards(0, 0));
    EXPECT_EQ(cone.width, 0);
    EXPECT_NEAR(cone.spread * cone.spread, solid_angle, 2e-3f * solid_angle);
  }
}

/// The plane seen in a flat mirror looks as it would to the mirrored camera.
TEST(RayCone, SeesInAFlatMirrorWhatTheMirroredCameraSees) {
  const Scene scene = one_object(test::textured_square(3, kSkewed), {}, tilted_camera());
  const Ray ray = scene.camera().ray(Vec2(0.45f, 0.6f));
  const Hit hit = hit_of(scene, ray);
  const PixelFootprint pixel(scene, kSide, kSide, 1);
  const Vertex seen(scene, scene.surface(hit), ray, hit, pixel.cone(ray.direction), &pixel);
  // Half way a mirror sends the ray aside; the cone goes on from there over the rest of the way.
  const float half = 0.5f * hit.distance;
  const Ray rest{ray.origin + half * ray.direction, 0, ray.direction};
  const Vertex mirrored(scene, scene.surface(hit), rest, hit_of(scene, rest), pixel.cone(ray.direction).at(half),
                        nullptr);
  const float area = std::abs(glm::determinant(seen.site.footprint));
  EXPECT_NEAR(std::abs(glm::determinant(mirrored.site.footprint)), area, 1e-3f * area);
  EXPECT_NEAR(mirrored.cone.width, seen.cone.width, 1e-5f * seen.cone.width);
}

struct Mapping {
  const char* name;
  Mat2 map;
  bool from_behind;
};

class LocalFrame : public testing::TestWithParam<Mapping> {};

TEST_P(LocalFrame, FollowsBothTextureCoordinatesOfWhatVaries) {
  const Mapping& mapping = GetParam();
  const Vec3 eye(0.5f, 0.3f, mapping.from_behind ? -4.0f : 4.0f);
  const Scene scene =
      one_object(test::textured_square(3, mapping.map), {}, Camera::look_at(eye, Vec3(0), {0, 1, 0}, 0.5f, 1));
  const auto vertex = vertex_at(scene, Vec2(0.5f));
  const Mat2 inverse = glm::inverse(mapping.map);
  const Vec3 along_u(inverse[0], 0), along_v(inverse[1], 0);
  EXPECT_NEAR(vertex->frame.to_local(glm::normalize(along_u)).x, 1, 1e-5f);
  EXPECT_GT(vertex->frame.to_local(along_v).y, 0);
  EXPECT_EQ(vertex->site.back, mapping.from_behind);
  EXPECT_NEAR(glm::distance(vertex->frame.to_world(vertex->wv), glm::normalize(eye)), 0, 1e-5f);
}

TEST_P(LocalFrame, IsRightHandedForUniformMaterials) {
  const Mapping& mapping = GetParam();
  const Vec3 eye(0.5f, 0.3f, mapping.from_behind ? -4.0f : 4.0f);
  const Scene scene =
      one_object(test::textured_square(3, mapping.map), {}, Camera::look_at(eye, Vec3(0), {0, 1, 0}, 0.5f, 1), false);
  const auto vertex = vertex_at(scene, Vec2(0.5f));
  EXPECT_NEAR(glm::dot(glm::cross(vertex->frame.x, vertex->frame.y), vertex->frame.z), 1, 1e-5f);
}

INSTANTIATE_TEST_SUITE_P(Mappings, LocalFrame,
                         testing::Values(Mapping{"Plain", Mat2(1), false}, Mapping{"Skewed", kSkewed, false},
                                         Mapping{"MirroredInU", Mat2(-2, 0, 0, 1), false},
                                         Mapping{"MirroredInV", Mat2(2, 0, 0, -1), false},
                                         Mapping{"TurnedHalf", Mat2(-1, 0, 0, -1), false},
                                         Mapping{"Behind", Mat2(1), true},
                                         Mapping{"MirroredBehind", Mat2(1, 0, 0.3f, -1), true}),
                         [](const auto& chosen) { return std::string(chosen.param.name); });

}  // namespace
}  // namespace velour::footprint_test
