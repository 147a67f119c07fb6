#include "capture/tile/bodies.h"

#include <gtest/gtest.h>

#include "base/process.h"
#include "support/tile_mesh.h"

namespace velour::testing {
namespace {

TEST(Packing, BallsRestOnTheFloorOrOnEachOtherAndDoNotMeet) {
  const PackingOptions options{.period = 2, .largest_radius = 0.2, .smallest_radius = 0.1, .volume = 0.6, .seed = 3};
  const std::vector<Ball> balls = pack_balls(options);
  double volume = 0;
  for (size_t i = 0; i < balls.size(); ++i) {
    const Ball& ball = balls[i];
    volume += 4 * kPiD / 3 * std::pow(ball.radius, 3);
    EXPECT_GE(ball.radius, options.smallest_radius);
    EXPECT_LE(ball.radius, options.largest_radius);
    EXPECT_TRUE(ball.center.x >= 0 && ball.center.x < 2 && ball.center.y >= 0 && ball.center.y < 2);
    double support = ball.center.z - ball.radius;  // distance from the nearest thing it may rest on
    EXPECT_GE(support, 0);
    for (size_t j = 0; j < i; ++j) {
      const double apart = glm::length(periodic_difference(ball.center, balls[j].center, 2));
      EXPECT_GE(apart, ball.radius + balls[j].radius - 1e-9);
      support = std::min(support, apart - ball.radius - balls[j].radius);
    }
    EXPECT_NEAR(support, 0, 1e-9) << "ball " << i << " hangs in the air";
  }
  EXPECT_GE(volume, options.volume);
}

TEST(Packing, ThousandsOfBallsTakeSeconds) {
  const double start = thread_seconds();
  const std::vector<Ball> balls =
      pack_balls({.period = 20, .largest_radius = 0.5, .smallest_radius = 0.3, .volume = 800});
  EXPECT_GT(balls.size(), 2000);
  EXPECT_LT(thread_seconds() - start, 4);
}

TEST(Packing, DifferencesTakeTheShortWay) {
  const Vec3d d = periodic_difference({0.1, 1.9, 0}, {1.9, 0.1, 1}, 2);
  EXPECT_NEAR(glm::length(d - Vec3d(-0.2, 0.2, 1)), 0, 1e-12);
}

/// Volume of a unit globe of `n` meridians and n / 2 steps from pole to pole: frusta over polygons.
double globe_volume(int n) {
  double sum = 0;
  for (int j = 0; j < n / 2; ++j) {
    const double a = 2 * kPiD * j / n, b = 2 * kPiD * (j + 1) / n;
    const double r = std::sin(a), s = std::sin(b);
    sum += (std::cos(a) - std::cos(b)) * (r * r + r * s + s * s) / 3;
  }
  return sum * polygon_area(n);
}

TEST(Gravel, WithoutIrregularityIsBalls) {
  const Tile tile = make_tile({.kind = "gravel", .irregularity = 0.0});
  double cubes = 0, squares = 0;
  for (const Ball& ball : gravel_balls(tile.shape)) {
    cubes += std::pow(ball.radius, 3);
    squares += std::pow(ball.radius, 2);
  }
  const double expected = globe_volume(tile.shape.resolution) * cubes;
  EXPECT_NEAR(volume(tile.parts.mesh, {1, 2, 3}) / expected, 1, 1e-4);
  EXPECT_NEAR(area(tile.parts.mesh, {1, 2, 3}) / (4 * kPiD * squares), 1, 0.03);
  const double floor = double(tile.period.x) * double(tile.period.y);
  EXPECT_NEAR(area(tile.parts.mesh, {0}) / floor, 1, 1e-6);
}

TEST(Gravel, StonesAreCutFromTheBalls) {
  const Tile tile = make_tile({.kind = "gravel"});
  const std::vector<Ball> balls = gravel_balls(tile.shape);
  const TileMesh& mesh = tile.parts.mesh;
  const size_t floor_vertices = 4, each = (mesh.positions.size() - floor_vertices) / balls.size();
  double most = 0, least = 1;
  for (size_t i = floor_vertices; i < mesh.positions.size(); ++i) {
    const Ball& ball = balls[(i - floor_vertices) / each];
    const double share = glm::length(Vec3d(mesh.positions[i]) - ball.center) / ball.radius;
    most = std::max(most, share);
    least = std::min(least, share);
  }
  EXPECT_LE(most, 1 + 1e-5);
  EXPECT_LT(least, 0.8);
}

}  // namespace
}  // namespace velour::testing
