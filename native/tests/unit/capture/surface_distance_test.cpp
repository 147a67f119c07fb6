#include "capture/surface_distance.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "sphere/random.h"

namespace velour {
namespace {

Vec3 random_point(RandomStream& numbers) { return {numbers.next(), numbers.next(), 0.5f * numbers.next()}; }

std::vector<Triangle> random_triangles(size_t count) {
  std::vector<Triangle> triangles;
  for (size_t i = 0; i < count; ++i) {
    RandomStream numbers(5, i, 0);
    const Vec3 at = random_point(numbers);
    triangles.push_back({{at, at + 0.2f * (random_point(numbers) - 0.5f), at + 0.2f * (random_point(numbers) - 0.5f)}});
  }
  return triangles;
}

/// Over a fine grid of the triangle.
float sampled_distance(const Triangle& t, const Vec3& p) {
  constexpr int kSteps = 60;
  float nearest = 1e9f;
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; i + j <= kSteps; ++j) {
      const float u = static_cast<float>(i) / kSteps, v = static_cast<float>(j) / kSteps;
      nearest = std::min(
          nearest, glm::length(t.corner[0] + u * (t.corner[1] - t.corner[0]) + v * (t.corner[2] - t.corner[0]) - p));
    }
  }
  return nearest;
}

TEST(SurfaceDistance, NearestPointOfATriangleIsNoFartherThanAnyOther) {
  for (const Triangle& t : random_triangles(20)) {
    for (uint64_t i = 0; i < 50; ++i) {
      RandomStream numbers(6, i, 0);
      const Vec3 p = random_point(numbers);
      const float found = glm::length(nearest_point(t, p) - p), sampled = sampled_distance(t, p);
      EXPECT_LE(found, sampled + 1e-5f);
      EXPECT_GE(found, sampled - 0.01f);
    }
  }
}

TEST(SurfaceDistance, IsThatOfTheNearestTriangleOfAllPeriods) {
  const std::vector<Triangle> triangles = random_triangles(12);
  const DistanceGrid grid{20, 16, 12, {0.025f, 0.025f, 0}, {0.05f, 0.05f, 0.05f}};  // a period of 1 x 0.8
  Progress progress;
  const std::vector<float> found = surface_distances(triangles, grid, progress);
  float worst_near = 0, worst = 0;
  for (uint32_t i = 0; i < found.size(); ++i) {
    const Vec3 p = grid.first + Vec3(i % 20, i / 20 % 16, i / 320) * grid.step;
    float expected = 1e9f;
    for (const Triangle& t : triangles) {
      for (int x = -1; x <= 1; ++x) {
        for (int y = -1; y <= 1; ++y) {
          const Vec3 moved = p + Vec3(static_cast<float>(x), 0.8f * static_cast<float>(y), 0);
          expected = std::min(expected, glm::length(nearest_point(t, moved) - moved));
        }
      }
    }
    const float error = std::abs(found[i] - expected);
    worst = std::max(worst, error);
    if (expected < 0.05f) worst_near = std::max(worst_near, error);
  }
  EXPECT_LT(worst_near, 1e-5f);
  EXPECT_LT(worst, 0.1f * grid.step.x) << "handed on from neighbour to neighbour";
}

TEST(SurfaceDistance, CanBeCancelled) {
  Progress progress;
  progress.cancel();
  EXPECT_THROW(surface_distances(random_triangles(3), {8, 8, 8, Vec3(0), Vec3(0.125f)}, progress), Error);
}

}  // namespace
}  // namespace velour
