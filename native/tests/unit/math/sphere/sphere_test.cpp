#include <gtest/gtest.h>

#include "math/sphere/directions.h"
#include "math/sphere/frame.h"
#include "math/sphere/quadrature.h"
#include "math/sphere/random.h"
#include "math/sphere/warp.h"
#include "support/statistics.h"

namespace velour::sphere_test {
namespace {

void expect_near(const Vec3& a, const Vec3& b, float tolerance) {
  EXPECT_NEAR(glm::distance(a, b), 0.0f, tolerance) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(Frame, IsOrthonormalAndRightHandedEverywhere) {
  for (const Vec3& axis : sphere_fibonacci(1000)) {
    const Frame f = Frame::about(axis);
    EXPECT_NEAR(glm::dot(f.x, f.y), 0, 1e-6);
    EXPECT_NEAR(glm::length(f.x), 1, 1e-6);
    expect_near(glm::cross(f.x, f.y), axis, 2e-6f);
    expect_near(f.to_local(f.to_world({0.1f, 0.2f, 0.3f})), {0.1f, 0.2f, 0.3f}, 1e-6f);
  }
}

TEST(Rotation, TakesOneDirectionToTheOther) {
  const auto set = sphere_fibonacci(60);
  for (const Vec3& from : set) {
    for (const Vec3& to : set) {
      const Mat3 r = rotation_between(from, to);
      expect_near(r * from, to, 3e-6f);
      EXPECT_NEAR(glm::determinant(r), 1.0f, 1e-5f);
    }
    expect_near(rotation_between(from, -from) * from, -from, 1e-6f);
  }
}

TEST(Directions, HemisphereSetIntegratesTheCosine) {
  const auto set = hemisphere_fibonacci(4096);
  double sum = 0;
  for (const Vec3& d : set) sum += d.z;
  EXPECT_NEAR(sum * 2 * kPiD / 4096, kPiD, 1e-6);
}

TEST(Directions, NearestAgreesWithSorting) {
  const auto set = hemisphere_fibonacci(200);
  const Vec3 d = direction(0.7f, 1.2f);
  int found[4];
  ASSERT_EQ(nearest_directions(set, d, 4, found), 4);
  std::vector<int> all(set.size());
  for (size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  std::stable_sort(all.begin(), all.end(), [&](int a, int b) {
    return glm::dot(set[static_cast<size_t>(a)], d) > glm::dot(set[static_cast<size_t>(b)], d);
  });
  for (int i = 0; i < 4; ++i) EXPECT_EQ(found[i], all[static_cast<size_t>(i)]);
  EXPECT_EQ(nearest_directions(std::span(set).first(2), d, 4, found), 2);
}

TEST(Quadrature, IsExactForPolynomials) {
  const Quadrature q = gauss_legendre(8, -1, 3);
  double sum = 0;
  for (size_t i = 0; i < q.node.size(); ++i) sum += q.weight[i] * std::pow(q.node[i], 15);
  EXPECT_NEAR(sum, (std::pow(3.0, 16) - 1) / 16, 1e-6);
}

TEST(Random, IsUniformIndependentOfOrderAndBelowOne) {
  test::RunningMean mean;
  for (uint64_t sample = 0; sample < 100000; ++sample) {
    const float u = RandomStream(7, 3, sample).next();
    ASSERT_GE(u, 0.0f);
    ASSERT_LT(u, 1.0f);
    mean.add(u);
  }
  EXPECT_GT(test::z_test(mean.estimate(), {0.5}), 1e-3);
  EXPECT_LT(unit_float(~0ULL), 1.0f);
  RandomStream a(1, 2, 3), b(1, 2, 3);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(a.next_bits(), b.next_bits());
}

TEST(Random, NeighboringStreamsAreUncorrelated) {
  double sum = 0;
  constexpr int n = 100000;
  for (uint64_t i = 0; i < n; ++i) {
    sum += (RandomStream(1, i, 0).next() - 0.5) * (RandomStream(1, i + 1, 0).next() - 0.5);
  }
  const double deviation = 1.0 / 12.0 / std::sqrt(static_cast<double>(n));
  EXPECT_LT(std::abs(sum / n), 4 * deviation);
}

TEST(Warp, CornersOfTheUnitSquareStayOnTheSphere) {
  for (const float a : {0.0f, 0.5f, 1.0f - 0x1p-24f}) {
    for (const float b : {0.0f, 0.5f, 1.0f - 0x1p-24f}) {
      EXPECT_NEAR(glm::length(sample_uniform_hemisphere({a, b})), 1, 1e-6);
      EXPECT_NEAR(glm::length(sample_uniform_sphere({a, b})), 1, 1e-6);
      EXPECT_NEAR(glm::length(sample_cosine_hemisphere({a, b})), 1, 1e-6);
    }
  }
}

}  // namespace
}  // namespace velour::sphere_test
