#include <gtest/gtest.h>

#include "base/simd.h"
#include "math/sphere/frame.h"
#include "math/sphere/random.h"
#include "support/mixtures.h"

namespace velour::sample_mixture_test {
namespace {

constexpr float kLast = 1 - 0x1p-24f;

TEST(SampleMixture, IsUnitAndFiniteAtTheEndsOfTheUnitSquare) {
  for (const Kernel kernel : {Kernel::gaussian, Kernel::abel_poisson}) {
    for (const float bandwidth : test::bandwidth_grid(kernel)) {
      for (const Vec3& center : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0), glm::normalize(Vec3(1, -2, 1e-3f))}) {
        for (const float share : {0.0f, 0.05f}) {
          LobeMixture mixture;
          mixture.clear(kernel);
          mixture.add(center, bandwidth, {1, 2, 3});
          mixture.add(-center, bandwidth, {1e-6f, 0, 0});
          mixture.finish(share);
          for (const float u : {0.0f, 0x1p-24f, 0.049999997f, 0.05f, 0.5f, kLast}) {
            for (const float v : {0.0f, 0.25f, kLast}) {
              EXPECT_NEAR(glm::length(sample_mixture(mixture, {u, v})), 1, 5e-7f) << bandwidth << ' ' << u << ' ' << v;
            }
          }
        }
      }
    }
  }
}

// Every 24-bit number must fall where the whole interval puts it: the share of samples of each lobe is its
// probability.
TEST(SampleMixture, ChoosesLobesByTheirProbability) {
  LobeMixture mixture;
  mixture.clear(Kernel::gaussian);
  const auto centers = sphere_fibonacci(6);
  for (size_t j = 0; j < centers.size(); ++j) mixture.add(centers[j], 1e4f, Rgb(static_cast<float>(j)));
  mixture.finish(0);
  std::vector<int> found(centers.size());
  constexpr int kSteps = 1 << 16;
  for (int i = 0; i < kSteps; ++i) {
    int nearest;
    nearest_directions(centers, sample_mixture(mixture, {static_cast<float>(i) / kSteps, 0.5f}), 1, &nearest);
    ++found[static_cast<size_t>(nearest)];
  }
  for (size_t j = 0; j < centers.size(); ++j) {
    EXPECT_NEAR(found[j], kSteps * static_cast<double>(j) / 15, 1.5) << j;
  }
}

// Nested lobes: where one slice of the numbers ends and the next begins, directions are next to each other.
TEST(SampleMixture, NeighboringSlicesMeet) {
  LobeMixture mixture;
  mixture.clear(Kernel::gaussian);
  for (const float bandwidth : {1.0f, 10.0f, 100.0f, 1000.0f}) mixture.add({0, 0, 1}, bandwidth, Rgb(bandwidth));
  mixture.finish(0);
  for (const int j : {0, 2}) {  // where both are at the center
    const Vec3 last = sample_mixture(mixture, {mixture.cdf[j] - 1e-5f, 0.3f});
    const Vec3 next = sample_mixture(mixture, {mixture.cdf[j] + 1e-5f, 0.3f});
    EXPECT_LT(glm::distance(last, next), 0.02f) << j;
  }
}

// The number left after the choice of a rare lobe still spreads over that lobe's zenith angles without bias.
TEST(SampleMixture, ZenithOfARareLobeIsNotQuantised) {
  LobeMixture mixture;
  mixture.clear(Kernel::gaussian);
  mixture.add({0, 0, 1}, 1, Rgb(1));
  mixture.add({0, 0, 1}, 1e6f, Rgb(2.0f));  // a few millionths of the mass
  mixture.finish(0);
  const double rare = 1 - mixture.cdf[0];
  ASSERT_LT(rare, 1e-5);
  const int steps = static_cast<int>(rare * 0x1p24);
  double sum = 0;
  for (int i = 1; i <= steps; ++i) {
    const Vec3 w = sample_mixture(mixture, {1 - static_cast<float>(i) * 0x1p-24f, 0.1f});
    sum += one_minus_dot(Vec3d(w), Vec3d(0, 0, 1)) * 1e6;
  }
  EXPECT_NEAR(sum / steps, 1, 0.05);  // mean of bandwidth x d under the lobe
}

/// What sample_mixture draws from a mixture of the one lobe, in double.
Vec3d reference_direction(const LobeMixture& m, const Vec2& u) {
  double rest = middle_of_step(u.x);
  const double share = m.cosine_share, phi = 2 * kPiD * static_cast<double>(u.y);
  if (rest < share) {
    const double z = std::sqrt(1 - rest / share), sine = std::sqrt(rest / share);
    return {sine * std::cos(phi), sine * std::sin(phi), z};
  }
  rest = (rest - share) / (1 - share);
  const double d = kernel_sample(m.kernel, m.bandwidth[0], rest), sine = std::sqrt(d * (2 - d));
  const Frame frame = Frame::about({m.x[0], m.y[0], m.z[0]});
  return sine * std::cos(phi) * Vec3d(frame.x) + sine * std::sin(phi) * Vec3d(frame.y) + (1 - d) * Vec3d(frame.z);
}

std::vector<Vec2> numbers() {
  std::vector<Vec2> u;
  RandomStream random(3, 1, 4);
  for (const float end : {0.0f, 0x1p-24f, 0.049999997f, 0.05f, kLast}) u.emplace_back(end, random.next());
  while (u.size() < 64) u.push_back(random.next2());
  return u;
}

TEST(SampleMixture, FollowsTheScalarReferenceOnEveryTarget) {
  const std::vector<Vec2> u = numbers();
  for (const std::string& target : simd_targets()) {
    ASSERT_TRUE(select_simd_target(target.c_str()));
    for (const Kernel kernel : {Kernel::gaussian, Kernel::abel_poisson}) {
      for (const float bandwidth : test::bandwidth_grid(kernel)) {
        for (const Vec3& center : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, 0, 0), glm::normalize(Vec3(1, -2, 3))}) {
          LobeMixture mixture;
          mixture.clear(kernel);
          mixture.add(center, bandwidth, {1, 2, 3});
          mixture.finish(0.05f);
          for (size_t count : {size_t{1}, size_t{7}, u.size()}) {
            DirectionBatch w;
            sample_mixture(mixture, std::span(u).first(count), w);
            ASSERT_EQ(w.count, static_cast<int>(count));
            for (size_t i = 0; i < count; ++i) {
              const Vec3d expected = reference_direction(mixture, u[i]), found(w.get(static_cast<int>(i)));
              // Roundings of the direction's numbers, and of 1 - cos, which moves the sine by its derivative: much at
              // the antipode, little near the axis.
              const double gap = one_minus_dot(expected, Vec3d(center)), sine = std::sqrt(gap * (2 - gap)) + 1e-15;
              const double of_sine = std::abs(1 - gap) * gap / sine;
              EXPECT_LT(glm::distance(found, expected), 6e-7 * (1 + of_sine))
                  << target << ' ' << kernel_name(kernel) << ' ' << bandwidth << ' ' << u[i].x << ' ' << center.x;
              if (center.z != 1.0f) continue;  // about the pole x and y have their digits, however small they are
              EXPECT_LT(std::hypot(found.x - expected.x, found.y - expected.y), 6e-7 * (sine + of_sine));
            }
          }
        }
      }
    }
  }
  select_simd_target("auto");
}

}  // namespace
}  // namespace velour::sample_mixture_test
