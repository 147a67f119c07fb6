#include "math/sphere/direction_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "math/sphere/directions.h"

namespace velour::direction_mesh_test {
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

using Vec2d = glm::dvec2;

Vec2d stereographic(const Vec3& d) { return Vec2d(d.x, d.y) / (1.0 + std::max(static_cast<double>(d.z), 0.0)); }

double cross(const Vec2d& a, const Vec2d& b) { return a.x * b.y - a.y * b.x; }

/// Whether all of `points` are on one side of the line through two of them.
bool on_hull(const std::vector<Vec2d>& points, const Vec2d& a, const Vec2d& b) {
  double least = 0, most = 0;
  for (const Vec2d& p : points) {
    least = std::min(least, cross(b - a, p - a));
    most = std::max(most, cross(b - a, p - a));
  }
  return least > -1e-9 || most < 1e-9;
}

Vec2d nearest_on(const Vec2d& a, const Vec2d& b, const Vec2d& p) {
  return a + glm::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0) * (b - a);
}

/// Where `p` is looked up: itself, or the nearest point of the hull of `points`, found among all pairs of them.
Vec2d looked_up(const std::vector<Vec2d>& points, const Vec2d& p) {
  std::vector<Vec2d> with = points;
  with.push_back(p);
  Vec2d nearest = p;
  double least = 1e30;
  bool outside = false;
  for (size_t i = 0; i < points.size(); ++i) {
    outside = outside || on_hull(with, points[i], p);  // p is a corner of the hull of all
    for (size_t j = 0; j < i; ++j) {
      if (!on_hull(points, points[i], points[j])) continue;
      const Vec2d q = nearest_on(points[i], points[j], p);
      if (glm::distance(p, q) >= least) continue;
      least = glm::distance(p, q);
      nearest = q;
    }
  }
  return outside ? nearest : p;
}

/// The largest share of its radius that any of `points` lies inside the circle through three of them.
double depth_in_circle(const std::vector<Vec2d>& points, const std::array<uint32_t, 3>& corners) {
  const Vec2d a = points[corners[0]], b = points[corners[1]] - a, c = points[corners[2]] - a;
  const double d = 2 * cross(b, c), bb = glm::dot(b, b), cc = glm::dot(c, c);
  const Vec2d center = a + Vec2d(c.y * bb - b.y * cc, b.x * cc - c.x * bb) / d;
  const double radius = glm::distance(center, a);
  double depth = 0;
  for (const Vec2d& p : points) depth = std::max(depth, 1 - glm::distance(center, p) / radius);
  return depth;
}

std::vector<Vec3> directions_to_look_up() {
  std::vector<Vec3> all = hemisphere_fibonacci(500);
  for (int i = 0; i < 360; ++i) {
    const float phi = radians_from(static_cast<float>(i));
    all.push_back(direction(kPi / 2, phi));
    all.push_back(direction(1.5f, phi));
  }
  for (const float theta : {0.1f, 0.6f, 1.0f, 1.3f, 1.5f, kPi / 2}) {
    for (const float phi : {-1e-3f, -1e-6f, 0.0f, 1e-6f, 1e-3f}) all.push_back(direction(theta, phi));
  }
  return all;
}

/// By the definition, tried on all directions of the set: the corners are those of a triangle whose circle is empty,
/// and the weights bring the place back; beyond the outline, the nearest place on it. At the horizon and across phi = 0
/// as anywhere.
TEST(DirectionMesh, IsWhatTryingAllDirectionsFinds) {
  std::vector<Vec3> bonn{{0, 0, 1}};
  const int counts[] = {6, 12, 18, 20, 24};
  for (int ring = 0; ring < 5; ++ring) {
    for (int i = 0; i < counts[ring]; ++i) {
      bonn.push_back(direction(radians_from(15.0f * static_cast<float>(ring + 1)),
                               2 * kPi * static_cast<float>(i) / static_cast<float>(counts[ring])));
    }
  }
  for (const std::vector<Vec3>& set : {rings(), bonn, hemisphere_fibonacci(100)}) {
    const DirectionMesh mesh(set);
    std::vector<Vec2d> points;
    for (const Vec3& d : set) points.push_back(stereographic(d));
    for (const Vec3& d : directions_to_look_up()) {
      const DirectionMesh::Weights w = mesh.at(d);
      Vec2d found(0.0);
      for (size_t k = 0; k < 3; ++k) found += static_cast<double>(w.weight[k]) * points[w.index[k]];
      const Vec2d expected = looked_up(points, stereographic(d));
      EXPECT_NEAR(glm::distance(found, expected), 0, 1e-4) << d.x << ' ' << d.y << ' ' << d.z;
      const double depth = w.index[0] != w.index[2] ? depth_in_circle(points, w.index) : 0.0;
      EXPECT_LT(depth, 1e-6);
    }
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
}  // namespace velour::direction_mesh_test
