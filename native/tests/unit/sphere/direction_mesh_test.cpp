#include "sphere/direction_mesh.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "sphere/directions.h"

namespace velour {
namespace {

std::vector<Vec3> rings() {
  std::vector<Vec3> set{{0, 0, 1}};
  for (int ring = 1; ring < 6; ++ring) {
    for (int i = 0; i < 4 * ring; ++i) {
      set.push_back(
          direction(0.26f * static_cast<float>(ring), 2 * kPi * static_cast<float>(i) / static_cast<float>(4 * ring)));
    }
  }
  return set;
}

float sum_at(const DirectionMesh& mesh, const std::vector<float>& values, const Vec3& d) {
  const DirectionMesh::Weights w = mesh.at(d);
  float sum = 0;
  for (size_t k = 0; k < 3; ++k) sum += w.weight[k] * values[w.index[k]];
  return sum;
}

TEST(DirectionMesh, GivesADirectionOfTheSetBack) {
  const std::vector<Vec3> set = rings();
  const DirectionMesh mesh(set);
  std::vector<float> numbers(set.size());
  std::iota(numbers.begin(), numbers.end(), 0.0f);
  for (size_t i = 0; i < set.size(); ++i) EXPECT_NEAR(sum_at(mesh, numbers, set[i]), numbers[i], 1e-3f) << i;
}

TEST(DirectionMesh, WeightsArePositiveAndSumToOneEverywhere) {
  const DirectionMesh mesh(rings());
  for (const Vec3& d : sphere_fibonacci(5000)) {
    const DirectionMesh::Weights w = mesh.at(d);
    EXPECT_NEAR(w.weight[0] + w.weight[1] + w.weight[2], 1.0f, 1e-6f);
    for (const float x : w.weight) EXPECT_TRUE(x >= 0 && x <= 1);
  }
}

/// Linear functions of the stereographic plane are interpolated exactly inside the outline, whatever the triangles.
TEST(DirectionMesh, CoversTheDiskOnceWithoutHoles) {
  const std::vector<Vec3> set = hemisphere_fibonacci(200);
  const DirectionMesh mesh(set);
  EXPECT_GE(mesh.triangles(), 370u);  // 2 n - 2 - (edges of the outline)
  std::vector<float> x;
  for (const Vec3& d : set) x.push_back(d.x / (1 + d.z));
  for (const Vec3& d : hemisphere_fibonacci(3000)) {
    if (d.z < 0.2f) continue;
    EXPECT_NEAR(sum_at(mesh, x, d), d.x / (1 + d.z), 1e-5f);
  }
}

/// Around every circle of constant theta - across phi = 0, through the last ring and to the horizon - the weights
/// change by no more than the step allows.
TEST(DirectionMesh, IsContinuousAcrossTheLastRingAndPhiZero) {
  const std::vector<Vec3> set = rings();
  const DirectionMesh mesh(set);
  std::vector<float> values;
  for (size_t i = 0; i < set.size(); ++i) values.push_back(static_cast<float>(i * 7919 % 13));
  const auto walk = [&](auto&& place) {
    float before = sum_at(mesh, values, place(0.0f)), largest = 0;
    for (int i = 1; i <= 20000; ++i) {
      const float now = sum_at(mesh, values, place(static_cast<float>(i) / 20000.0f));
      largest = std::max(largest, std::abs(now - before));
      before = now;
    }
    return largest;
  };
  for (const float theta : {0.1f, 0.7f, 1.29f, 1.305f, 1.5f, 1.57f}) {
    EXPECT_LT(walk([&](float t) { return direction(theta, 2 * kPi * (t - 0.5f)); }), 0.08f) << theta;
  }
  for (const float phi : {0.0f, 0.4f, 3.1f}) {
    EXPECT_LT(walk([&](float t) { return direction(1.57f * t, phi); }), 0.02f) << phi;
  }
}

TEST(DirectionMesh, OfOneOrTwoDirectionsIsTheNearestPointBetween) {
  const std::vector<Vec3> one{{0, 0, 1}};
  EXPECT_EQ(DirectionMesh(one).at({1, 0, 0}).index[0], 0u);
  const std::vector<Vec3> two{direction(0.5f, 0.0f), direction(0.5f, kPi)};
  const DirectionMesh mesh(two);
  EXPECT_NEAR(sum_at(mesh, {0, 1}, {0, 0, 1}), 0.5f, 1e-6f);
  EXPECT_NEAR(sum_at(mesh, {0, 1}, direction(1.2f, 0.0f)), 0.0f, 1e-6f);
}

}  // namespace
}  // namespace velour
