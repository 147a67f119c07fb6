// Film, vertex and lattice: the small parts of a render.
#include "render/film/film.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "math/sphere/random.h"
#include "render/path/path_numbers.h"
#include "render/path/vertex.h"

namespace velour::film_test {
namespace {

TEST(Film, MeansOfWhatWasAdded) {
  Film film(3, 2);
  const PixelRect rect{1, 1, 2, 2};
  std::vector<PixelSum> sums(1);
  film.load(rect, sums);
  sums[0].add({.radiance = Rgb(2, 4, 6), .alpha = 1, .normal = {0, 0, 1}, .depth = 7, .directions = 8});
  sums[0].add({.radiance = Rgb(0.0f), .alpha = 0, .normal = {0, 0, 0}, .directions = 5});
  film.store(rect, sums);
  std::vector<float> combined(24), depth(6), normal(18), count(6);
  film.read_pass("Combined", combined);
  film.read_pass("Depth", depth);
  film.read_pass("Normal", normal);
  film.read_pass("Sample Count", count);
  const size_t at = 4;  // row 1, column 1
  EXPECT_EQ(combined[4 * at + 1], 2);
  EXPECT_EQ(combined[4 * at + 3], 0.5f);
  EXPECT_EQ(depth[at], 7);
  EXPECT_EQ(normal[3 * at + 2], 0.5f);
  EXPECT_EQ(count[at], 13);
  EXPECT_EQ(count[0], 0);
  EXPECT_EQ(combined[0], 0);
  film.clear();
  film.read_pass("Combined", combined);
  EXPECT_EQ(combined[4 * at + 1], 0);
}

TEST(Film, RefusesUnknownPassesAndWrongSizes) {
  Film film(2, 2);
  std::vector<float> pixels(16);
  EXPECT_THROW(film.read_pass("combined", pixels), Error);
  EXPECT_THROW(film.read_pass("Depth", pixels), Error);
  const Film coarser(1, 1);
  EXPECT_NO_THROW(film.read_over(&coarser, pixels)) << "control";
  EXPECT_THROW(film.read_over(&coarser, std::span(pixels).first(12)), Error);
  EXPECT_THROW(Film(0, 2), Error);
}

TEST(Film, NoiseIsTheErrorThatTheHalvesTellOverTheMean) {
  Film film(1, 1);
  std::vector<PixelSum> sums(1);
  EXPECT_EQ(film.noise(), 0);
  for (float y : {1.0f, 3.0f, 1.0f, 3.0f}) sums[0].add({.radiance = Rgb(y)});
  film.store({0, 0, 1, 1}, sums);
  EXPECT_NEAR(film.noise(), 0.5, 1e-6);
}

SurfacePoint tilted_point(const Vec3& shading_normal) {
  return {.position = Vec3(0.0f),
          .geometric_normal = {0, 0, 1},
          .shading_normal = glm::normalize(shading_normal),
          .tangent = Vec3(0.0f),
          .error = 0,
          .material = 0};
}

TEST(Vertex, BothNormalsFaceTheViewer) {
  const Vec3 below = glm::normalize(Vec3(0.3f, 0, -1));
  const Vertex vertex(tilted_point({0.2f, 0, 1}), below);
  EXPECT_LT(vertex.geometric_normal.z, 0);
  EXPECT_LT(vertex.frame.z.z, 0);
  EXPECT_GT(vertex.wv.z, 0);
}

TEST(Vertex, ShadingNormalBendsContinuouslyToTheViewer) {
  const Vec3 normal = glm::normalize(Vec3(-0.8f, 0, 0.6f));
  Vec3 before(0.0f);
  for (int i = 0; i <= 1000; ++i) {
    const float angle = kPi / 2 * static_cast<float>(i) / 1001.0f;
    const Vertex vertex(tilted_point(normal), {std::sin(angle), 0, std::cos(angle)});
    EXPECT_GE(vertex.wv.z, 0.999f * Vertex::kMinCosine / 1.02f);
    EXPECT_NEAR(glm::length(vertex.frame.z), 1, 1e-5f);
    EXPECT_NEAR(glm::dot(vertex.frame.x, vertex.frame.z), 0, 1e-5f);
    if (i > 0) {
      EXPECT_LT(glm::length(vertex.frame.z - before), 0.01f);
    }
    before = vertex.frame.z;
  }
}

TEST(Vertex, TangentFollowsTheTextureCoordinate) {
  SurfacePoint point = tilted_point({0.1f, 0.1f, 1});
  point.tangent = {0, 5, 0};
  const Vertex vertex(point, {0, 0, 1});
  EXPECT_GT(vertex.frame.x.y, 0.99f);
  EXPECT_NEAR(glm::dot(glm::cross(vertex.frame.x, vertex.frame.y), vertex.frame.z), 1, 1e-5f);
}

TEST(Lattice, PointsAreUniformUnderTheShift) {
  RandomStream random(1, 1, 1);
  double sum_x = 0, sum_y = 0, sum_xy = 0;
  const int n = 100000;
  for (int i = 0; i < n; ++i) {
    const Vec2 p = lattice_point(3, 4, random.next2());
    ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
    sum_x += p.x;
    sum_y += p.y;
    sum_xy += p.x * p.y;
  }
  EXPECT_NEAR(sum_x / n, 0.5, 0.005);
  EXPECT_NEAR(sum_y / n, 0.5, 0.005);
  EXPECT_NEAR(sum_xy / n, 0.25, 0.005);
}

TEST(Lattice, StaysBelowOne) {
  const float most = 0x1.fffffep-1f;
  for (int n = 1; n <= 48; ++n) {
    for (int i = 0; i < n; ++i) {
      const Vec2 p = lattice_point(i, n, {most, most});
      EXPECT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
    }
  }
}

}  // namespace
}  // namespace velour::film_test
