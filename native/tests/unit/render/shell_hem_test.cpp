// Shells of surfaces that end: what is seen of the structure from the side.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "math/sphere/directions.h"
#include "math/sphere/random.h"
#include "render/path/shadow_queue.h"
#include "render/path/vertex.h"
#include "support/example_shell.h"
#include "support/test_scene.h"

namespace velour::shell_hem_test {
namespace {

constexpr float kRadius = 0.2f;  // of wires a tile apart, tiles
constexpr int kTiles = 8;        // along the sides of the sheet
constexpr float kTile = 2.0f / kTiles;

/// Square of side 2 in the plane z = 0, of many quads.
Mesh sheet(uint32_t quads) {
  std::vector<Vec3> p;
  std::vector<glm::uvec3> t;
  std::vector<Vec2> uv;
  const auto share = [&](uint32_t i) { return static_cast<float>(i) / static_cast<float>(quads); };
  for (uint32_t i = 0; i <= quads; ++i) {
    for (uint32_t j = 0; j <= quads; ++j) p.emplace_back(2 * share(j) - 1, 2 * share(i) - 1, 0);
  }
  for (uint32_t i = 0; i < quads; ++i) {
    for (uint32_t j = 0; j < quads; ++j) {
      const uint32_t a = i * (quads + 1) + j, b = a + quads + 1;
      for (const glm::uvec3& corner : {glm::uvec3(a, a + 1, b + 1), glm::uvec3(a, b + 1, b)}) {
        t.push_back(corner);
        for (int k = 0; k < 3; ++k) uv.push_back(Vec2(Vec2(p[corner[k]]) + 1.0f) * (0.5f * kTiles));
      }
    }
  }
  return Mesh({.positions = p, .triangles = t, .corner_uvs = uv});
}

/// The sheet of wires along y, `stretch` times as long, `x` from the origin.
void add_sheet(Scene& scene, float stretch, float x, bool mirrored) {
  scene.add_instance(0, test::shift({x, 0, 0}, {mirrored ? -1.0f : 1.0f, stretch, 1}), {0});
}

Scene wires_in_sheets(bool shaded = true) {
  Scene scene;
  scene.add_material({.material = std::make_shared<test::Lambert>(1.0f),
                      .shell = std::make_shared<const ShellField>(test::wires(128, kRadius)),
                      .shell_shaded = shaded});
  scene.set_shell_tile(0, kTile);
  scene.add_mesh(sheet(6));
  return scene;
}

/// Where a ray comes into the wires of a sheet, solid, cut off where it ends; infinite: nowhere.
float closed_form(const Ray& ray, float stretch, float radius) {
  float nearest = std::numeric_limits<float>::infinity();
  for (int i = 0; i < kTiles; ++i) {
    const double x = ray.origin.x - ((i + 0.5) * kTile - 1), z = ray.origin.z, dx = ray.direction.x,
                 dz = ray.direction.z, a = dx * dx + dz * dz, b = x * dx + z * dz,
                 c = x * x + z * z - double{radius} * double{radius}, square = b * b - a * c;
    if (square < 0) continue;
    double begin = (-b - std::sqrt(square)) / a, end = (-b + std::sqrt(square)) / a;
    if (a == 0) begin = -1e9, end = c <= 0 ? 1e9 : -1e9;
    const double y1 = (-stretch - ray.origin.y) / ray.direction.y, y2 = (stretch - ray.origin.y) / ray.direction.y;
    begin = std::max({begin, std::min(y1, y2), 0.0});
    end = std::min(end, std::max(y1, y2));
    if (begin < end) nearest = std::min(nearest, static_cast<float>(begin));
  }
  return nearest;
}

/// Rays of all directions, `flat` ones along the sheet exactly, to places within the shell; some begin there.
Ray ray_about(uint64_t number, float stretch, bool flat) {
  RandomStream numbers(11, number, 0);
  const Vec2 at = numbers.next2(), turn = numbers.next2();
  const Vec3 place(2.1f * at.x - 1.05f, stretch * (2.1f * at.y - 1.05f),
                   1.07f * kTile * kRadius * (2 * numbers.next() - 1));
  const float azimuth = kPi / 2 * (number % 2 == 0 ? 1.0f : -1.0f) + 0.2f * turn.x - 0.1f;
  const Vec3 w = flat ? Vec3(std::cos(azimuth), std::sin(azimuth), 0)
                      : direction(std::acos(0.4f * turn.x - 0.2f), 2 * kPi * turn.y);
  // No ray is asked anything where it leaves through the bottom.
  const bool within =
      !flat && number % 4 == 0 && w.z > 0 && closed_form({place, 0, w}, stretch, kTile * kRadius) > 0.01f;
  return {within ? place : place - 6.0f * w, 0, w};
}

struct Wrong {
  double share = 0, share_of_thicker = 0, met = 0;
};

Wrong wrong_of(float stretch, bool mirrored, bool flat) {
  Scene scene = wires_in_sheets();
  add_sheet(scene, stretch, 0, mirrored);
  add_sheet(scene, 1, 40, false);
  scene.commit(1);
  const VisibleRays visible(scene);
  constexpr int kRays = 6000;
  Wrong wrong;
  for (uint64_t i = 0; i < kRays; ++i) {
    const Ray ray = ray_about(i, stretch, flat);
    Hit hit;
    visible.intersect({&ray, 1}, &hit);
    const bool met = hit.instance == 0;
    EXPECT_EQ(visible.occluded(ray), hit.instance != kNoHit) << i;
    wrong.met += met ? 1.0 / kRays : 0;
    const auto meets = [&](float radius) { return std::isfinite(closed_form(ray, stretch, radius)); };
    wrong.share += met != meets(kTile * kRadius) ? 1.0 / kRays : 0;
    wrong.share_of_thicker += met != meets(1.1f * kTile * kRadius) ? 1.0 / kRays : 0;
  }
  return wrong;
}

TEST(ShellHem, ASheetOfWiresSeenFromTheSideIsWhatItsClosedFormSays) {
  for (const bool flat : {true, false}) {
    for (const float stretch : {1.0f, 2.0f}) {
      for (const bool mirrored : {false, true}) {
        const Wrong wrong = wrong_of(stretch, mirrored, flat);
        EXPECT_LT(wrong.share, 0.005) << flat << stretch << mirrored;
        EXPECT_GT(wrong.share_of_thicker, 0.01) << "a tenth of the radius would be noticed";
        EXPECT_GT(wrong.met, 0.3);
        EXPECT_LT(wrong.met, 0.95);
      }
    }
  }
}

TEST(ShellHem, WhatIsSeenLiesOnTheWiresAndWhereTheyAreCut) {
  Scene scene = wires_in_sheets();
  add_sheet(scene, 1, 0, false);
  scene.commit(1);
  const VisibleRays visible(scene);
  int cut = 0, seen = 0, off = 0, dark = 0;
  for (uint64_t i = 0; i < 4000; ++i) {
    const Ray ray = ray_about(i, 1, i % 2 == 0);
    Hit hit;
    visible.intersect({&ray, 1}, &hit);
    const float distance = closed_form(ray, 1, kTile * kRadius);
    if (hit.instance == kNoHit || !std::isfinite(distance)) continue;
    const Vertex vertex = Vertex::seen(scene, ray, hit, {0, 0}, nullptr);
    const Vec3 expected = ray.origin + distance * ray.direction;
    const bool at_end = std::abs(std::abs(expected.y) - 1) < 1e-4f;
    if (at_end) {
      EXPECT_GT(std::abs(vertex.geometric_normal.y), 0.999f) << i;
    }
    ++seen;
    cut += at_end ? 1 : 0;
    // At grazing angles rays find outlines a little earlier or later.
    off += glm::length(vertex.position - expected) > 0.05f * kTile ? 1 : 0;
    dark += visible.occluded(vertex.ray(vertex.geometric_normal, 0.3f * kTile)) ? 1 : 0;
  }
  EXPECT_GT(seen, 1500);
  EXPECT_GT(cut, 100);
  EXPECT_LT(off, 0.01 * seen);
  EXPECT_LT(dark, 0.01 * seen);
}

TEST(ShellHem, SurfacesWithoutEndHaveNoSides) {
  Scene scene = wires_in_sheets();
  // A tube whose texture coordinates and vertices have a seam.
  std::vector<Vec3> p;
  std::vector<glm::uvec3> t;
  std::vector<Vec2> uv;
  const Mesh ball = test::sphere(16);
  for (const glm::uvec3& corner : ball.triangles()) {
    for (int k = 0; k < 3; ++k) uv.push_back(Vec2(corner[k] % 33, corner[k] / 33) / 4.0f);
  }
  scene.add_instance(
      scene.add_mesh(Mesh({.positions = ball.positions(), .triangles = ball.triangles(), .corner_uvs = uv})), {}, {0});
  scene.commit(1);
  EXPECT_EQ(scene.instances()[0].sides, kNoHit);
  add_sheet(scene, 1, 10, false);
  scene.commit(1);
  EXPECT_EQ(scene.instances()[0].sides, kNoHit);
  EXPECT_NE(scene.instances()[1].sides, kNoHit);
  const Mesh& traced = scene.traced_mesh(scene.instances()[1]);
  EXPECT_EQ(traced.triangles().size() - traced.first_side(), 2u * 4 * 6);
}

TEST(ShellHem, APictureOfTheCutEndOfAWireIsADiskThatIsLit) {
  for (const bool shaded : {false, true}) {
    Scene scene = wires_in_sheets(shaded);
    add_sheet(scene, 1, 0, false);
    scene.set_environment(Environment::constant(Rgb(1.0f)));
    // 20 from the middle, which the picture shows a tenth about, and 19 from the end.
    scene.set_camera(Camera::look_at({kTile / 2, -20, 0}, {kTile / 2, 0, 0}, {0, 0, 1}, 2 * std::atan(0.1f / 20), 1));
    scene.commit(1);
    RenderOptions options = test::small_options(Strategy::cosine, 64);
    options.width = options.height = 32;
    options.bounces = 2;
    options.transparent = true;
    const std::vector<float> pixels = test::rendered(scene, options);
    for (const float v : pixels) ASSERT_TRUE(v >= 0 && v < 1.01f) << v;
    const double disk = kPiD * std::pow(10 * 20.0 / 19 * static_cast<double>(kTile * kRadius), 2) / 4;
    EXPECT_NEAR(test::mean_of(pixels, 3), disk, 0.01 * disk) << shaded;
    // White under white.
    EXPECT_NEAR(test::mean_of(pixels, 0), disk, 0.02 * disk) << shaded;
  }
}

}  // namespace
}  // namespace velour::shell_hem_test
