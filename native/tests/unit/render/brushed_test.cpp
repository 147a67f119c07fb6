// Anisotropic materials that are the same all over: which way they lie on a surface.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "material/microfacet/ggx_sampler.h"
#include "math/sphere/directions.h"
#include "render/path/vertex.h"
#include "support/textured_scenes.h"

namespace velour::brushed_test {
namespace {

constexpr int kPixels = 32;

SurfaceMaterial brushed(const Vec2& alpha) {
  return {.material = make_ggx_material({.alpha = alpha, .f0 = Rgb(0.8f), .f90 = Rgb(1)}), .brushed = true};
}

const SurfaceMaterial kBrushed = brushed({0.05f, 0.4f});

TextureMap turned(float angle) {
  const float c = std::cos(angle), s = std::sin(angle);
  return {Mat2(c, -s, s, c), {0, 0}};
}

Scene scene_of(const Mesh& mesh, const SurfaceMaterial& material, std::vector<TextureMap> placements = {},
               const Affine& place = {}) {
  Scene scene;
  scene.add_instance(scene.add_mesh(mesh), place, {scene.add_material(material)}, std::move(placements));
  scene.set_environment(Environment::constant(Rgb(1)));
  scene.set_camera(Camera::look_at({0.3f, -2, 3}, {0, 0, 0}, {0, 0, 1}, 0.6f, 1));
  scene.commit(1);
  return scene;
}

std::optional<Vertex> seen(const Scene& scene, const Ray& ray) {
  Hit hit;
  scene.rays().intersect(ray, hit);
  if (hit.instance == kNoHit) return {};
  return Vertex(scene, scene.surface(hit), ray, hit, {}, nullptr);
}

/// Vertices where the camera's rays meet the scene; empty where they miss it.
std::vector<std::optional<Vertex>> vertices(const Scene& scene) {
  std::vector<std::optional<Vertex>> all;
  for (int i = 0; i < kPixels * kPixels; ++i) {
    const Vec2 pixel(static_cast<float>(i % kPixels), static_cast<float>(i / kPixels));
    all.push_back(seen(scene, scene.camera().ray((pixel + 0.5f) / static_cast<float>(kPixels))));
  }
  return all;
}

/// f for light from directions all around.
std::vector<float> reflected(const Vertex& vertex) {
  ScratchArena arena;
  const PreparedBrdf* const point = vertex.surface->material->prepare(vertex.wv, vertex.site, {}, arena);
  std::vector<float> f;
  for (const Vec3& wl : hemisphere_fibonacci(20)) {
    f.push_back(point->eval_one(vertex.frame.to_local(wl)).f.r);
  }
  return f;
}

/// The largest difference over the largest value, on what both show.
float difference(const Scene& a, const Scene& b) {
  const auto of_a = vertices(a), of_b = vertices(b);
  float worst = 0, largest = 0;
  for (size_t i = 0; i < of_a.size(); ++i) {
    if (!of_a[i] || !of_b[i]) continue;
    const auto x = reflected(*of_a[i]), y = reflected(*of_b[i]);
    for (size_t k = 0; k < x.size(); ++k) {
      worst = std::max(worst, std::abs(x[k] - y[k]));
      largest = std::max(largest, x[k]);
    }
  }
  return worst / largest;
}

TEST(Brushed, AQuarterTurnExchangesItsAxes) {
  for (const Mesh& mesh : {test::repeating_square(1, 1), test::textured_sphere(12)}) {
    const Scene exchanged = scene_of(mesh, brushed({0.4f, 0.05f}));
    EXPECT_LT(difference(exchanged, scene_of(mesh, kBrushed, {turned(kPi / 2)})), 2e-4f);
    EXPECT_GT(difference(exchanged, scene_of(mesh, kBrushed)), 0.1f);
  }
}

/// By angles on the surface: a picture that is stretched there does not slant it.
TEST(Brushed, StretchedCoordinatesTurnItNoFurther) {
  const Scene stretched = scene_of(test::textured_square(1, Mat2(5, 0, 0, 0.5f)), kBrushed, {turned(0.7f)});
  const Affine by_hand{{std::cos(0.7f), -std::sin(0.7f), 0, 0, std::sin(0.7f), std::cos(0.7f), 0, 0, 0, 0, 1, 0}};
  EXPECT_LT(difference(scene_of(test::repeating_square(1, 1), kBrushed, {}, by_hand), stretched), 2e-4f);
}

Vec3 along(const Mesh& mesh, const std::vector<TextureMap>& placements, const Affine& place, float from = 3) {
  const auto vertex = seen(scene_of(mesh, kBrushed, placements, place), {{0.1f, 0.2f, from}, 0, {0, 0, -from / 3}});
  EXPECT_NEAR(glm::dot(glm::cross(vertex->frame.x, vertex->frame.y), vertex->frame.z), 1, 1e-5f);  // never mirrored
  return vertex->frame.x;
}

TEST(Brushed, MirroredPicturesTurnTheOtherWay) {
  const Mesh plain = test::repeating_square(1, 1), mirrored = test::textured_square(1, Mat2(-1, 0, 0, 1));
  const Vec3 expected(std::cos(0.3f), std::sin(0.3f), 0), other(-expected.x, expected.y, 0);
  const Affine mirror = test::shift(Vec3(0.0f), {-1, 1, 1});
  EXPECT_LT(glm::distance(along(plain, {turned(0.3f)}, {}), expected), 1e-5f);
  EXPECT_LT(glm::distance(along(plain, {turned(0.3f)}, {}, -3), expected), 1e-5f);  // from behind
  EXPECT_LT(glm::distance(along(mirrored, {turned(0.3f)}, {}), other), 1e-5f);
  EXPECT_LT(glm::distance(along(plain, {turned(0.3f)}, mirror), other), 1e-5f);
  EXPECT_LT(glm::distance(along(mirrored, {turned(0.3f)}, mirror), expected), 1e-5f);
}

TEST(Brushed, AScaledObjectTakesItAlong) {
  const Vec3 stretched = glm::normalize(Vec3(3 * std::cos(0.3f), std::sin(0.3f), 0));
  EXPECT_LT(
      glm::distance(along(test::repeating_square(1, 1), {turned(0.3f)}, test::shift(Vec3(0.0f), {3, 1, 1})), stretched),
      1e-5f);
}

/// Away from the poles, where longitudes meet, and from where they begin: each side of a seam has tangents of its own.
bool is_even(const Vec3& p) { return std::abs(p.z) < 0.7f && std::abs(std::atan2(p.y, p.x)) > kPi / 12; }

/// Degrees between +x and the parallel that it should follow, at most, on a sphere of n x 2n quads.
double off(uint32_t n, bool smooth) {
  SurfaceMaterial material = kBrushed;
  material.brushed = smooth;
  const Scene scene = scene_of(test::textured_sphere(n), material);
  double worst = 0;
  for (const auto& vertex : vertices(scene)) {
    if (!vertex || !is_even(vertex->position)) continue;
    const Vec3 east = vertex->frame.to_local({-vertex->position.y, vertex->position.x, 0});
    worst = std::max(worst, static_cast<double>(std::abs(std::atan2(east.y, east.x)) * 180 / kPi));
  }
  return worst;
}

TEST(Brushed, IsAsSmoothOnACoarseSphereAsOnAFineOne) {
  EXPECT_LT(off(96, true), 0.1);
  EXPECT_LT(off(12, true), 0.5);
  EXPECT_GT(off(12, false), 4);  // facets
}

TEST(Brushed, NothingElseNeedsTangents) {
  const Mesh mesh = test::repeating_square(1, 1);
  SurfaceMaterial round = brushed(Vec2(0.2f));
  round.brushed = false;
  Scene scene = scene_of(mesh, round);
  EXPECT_FALSE(scene.meshes()[0].has_tangents());
  scene.set_material(0, round);
  EXPECT_TRUE(scene.committed());
  scene.set_material(0, kBrushed);
  EXPECT_FALSE(scene.committed());
  scene.commit(1);
  EXPECT_TRUE(scene.meshes()[0].has_tangents());
  EXPECT_EQ(difference(scene, scene_of(mesh, kBrushed)), 0);
}

TEST(Brushed, WithoutTextureCoordinatesItLiesSomehow) {
  const Scene scene = scene_of(test::sphere(12), kBrushed, {turned(0.3f)});
  for (const auto& vertex : vertices(scene)) {
    if (!vertex) continue;
    EXPECT_NEAR(glm::length(vertex->frame.x), 1, 1e-5f);
  }
}

}  // namespace
}  // namespace velour::brushed_test
