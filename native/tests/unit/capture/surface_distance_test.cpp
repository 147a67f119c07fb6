#include "votf/capture/surface_distance.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "math/sphere/random.h"

namespace velour::surface_distance_test {
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
  EXPECT_LT(worst, 0.1f * grid.step.x) << "handed on from neighbor to neighbor";
}

float worst_distance(const Vec3& normal, const std::vector<float>& level, const std::vector<float>& found) {
  float worst = 0;
  for (size_t i = 0; i < level.size(); ++i) {
    worst = std::max(worst, std::abs(found[i] - std::abs(level[i]) / glm::length(normal)));
  }
  return worst;
}

TEST(SurfaceDistance, OfALevelIsThatOfThePlaneThatItIsZeroOn) {
  const DistanceGrid grid{24, 24, 24, Vec3(0), {0.04f, 0.05f, 0.03f}};
  Progress progress;
  for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(0, 0, -3)}) {
    std::vector<float> level;
    for (uint32_t i = 0; i < 24 * 24 * 24; ++i) {
      level.push_back(glm::dot(Vec3(i % 24, i / 24 % 24, i / 576) * grid.step - 0.37f, normal));
    }
    EXPECT_LT(worst_distance(normal, level, level_distances(level, grid, progress)), 1e-5f);
  }
}

TEST(SurfaceDistance, OfALevelGoesOnAcrossThePeriodButNotAlongZ) {
  const DistanceGrid grid{16, 1, 8, Vec3(0), Vec3(1.0f)};
  Progress progress;
  std::vector<float> level(16 * 8, 1.0f);
  for (size_t z = 0; z < 8; ++z) level[z * 16] = -1;  // a wall at x = 0, and so at 16
  const std::vector<float> found = level_distances(level, grid, progress);
  for (size_t z = 0; z < 8; ++z) {
    EXPECT_NEAR(found[z * 16 + 1], 0.5f, 1e-6f);
    EXPECT_NEAR(found[z * 16 + 15], 0.5f, 1e-6f);
    EXPECT_NEAR(found[z * 16 + 12], 3.5f, 1e-6f);
  }
  level.assign(level.size(), 1.0f);
  for (size_t x = 0; x < 16; ++x) level[x] = -1;  // a floor
  EXPECT_NEAR(level_distances(level, grid, progress)[7 * 16], 6.5f, 1e-6f);
  level.assign(level.size(), 1.0f);
  EXPECT_TRUE(std::isinf(level_distances(level, grid, progress)[0]));
}

TEST(SurfaceDistance, OfASphereIsThatOfItsTangentPlanes) {
  const DistanceGrid grid{32, 32, 32, Vec3(-0.5f + 1.0f / 64), Vec3(1.0f / 32)};
  Progress progress;
  std::vector<float> level;
  for (uint32_t i = 0; i < 32 * 32 * 32; ++i) {
    level.push_back(glm::length(grid.first + Vec3(i % 32, i / 32 % 32, i / 1024) * grid.step) - 0.3f);
  }
  const std::vector<float> found = level_distances(level, grid, progress);
  float near = 0, beyond = 0;  // worst errors up to a step from the sphere, and up to three
  for (size_t i = 0; i < found.size(); ++i) {
    const float truth = std::abs(level[i]) / grid.step.x, error = std::abs(found[i] / grid.step.x - truth);
    if (truth < 1) near = std::max(near, error);
    if (truth < 3) beyond = std::max(beyond, error);
  }
  EXPECT_LT(near, 0.06f);
  EXPECT_LT(beyond, 0.4f) << "handed on from neighbor to neighbor";
}

TEST(SurfaceDistance, CanBeCancelled) {
  Progress progress;
  progress.cancel();
  const DistanceGrid grid{8, 8, 8, Vec3(0), Vec3(0.125f)};
  EXPECT_THROW(surface_distances(random_triangles(3), grid, progress), Error);
  EXPECT_THROW(level_distances(std::vector<float>(512, 1.0f), grid, progress), Error);
}

}  // namespace
}  // namespace velour::surface_distance_test
