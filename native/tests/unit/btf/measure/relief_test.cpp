#include "btf/measure/relief.h"

#include <gtest/gtest.h>

#include <cmath>

#include "math/sphere/directions.h"
#include "math/sphere/random.h"
#include "support/simd_targets.h"

namespace velour::relief_test {
namespace {

Vec3 towards(float theta_degrees, float phi_degrees) {
  return direction(theta_degrees * kPi / 180, phi_degrees * kPi / 180);
}

/// Grooves along y with faces of 45 degrees: lowest at the center of texel 0, highest half a tile further.
Relief sawtooth(uint32_t width) {
  std::vector<float> heights;
  for (uint32_t x = 0; x < width; ++x) {
    heights.push_back(static_cast<float>(std::min(x, width - x)) / static_cast<float>(width));
  }
  return {width, 1, heights, 1};
}

Relief random_relief(uint64_t seed, uint32_t width, uint32_t height, float high, float aspect) {
  RandomStream random(seed, 0, 0);
  std::vector<float> heights(size_t{width} * height);
  for (float& h : heights) h = high * (random.next() - 0.3f);
  return {width, height, heights, aspect};
}

/// Hills and dales about the reference plane.
Relief waves(uint32_t width, uint32_t height, float high, float aspect) {
  std::vector<float> heights;
  for (uint32_t t = 0; t < width * height; ++t) {
    const float x = 2 * kPi * static_cast<float>(t % width) / static_cast<float>(width);
    const float y = 2 * kPi * static_cast<float>(t / width) / static_cast<float>(height);
    heights.push_back(high * (0.4f * std::sin(x + y) + 0.3f * std::cos(2 * y - x) + 0.3f * std::sin(3 * x)));
  }
  return {width, height, heights, aspect};
}

float height_at(const Relief& relief, const Vec2& place) {
  const auto wrap = [](int i, uint32_t n) {
    return static_cast<uint32_t>((i % static_cast<int>(n) + static_cast<int>(n)) % static_cast<int>(n));
  };
  const Vec2 texel = place * Vec2(relief.width(), relief.height()) - 0.5f, low = glm::floor(texel), part = texel - low;
  float sum = 0;
  for (int corner = 0; corner < 4; ++corner) {
    const int dx = corner & 1, dy = corner >> 1;
    const uint32_t x = wrap(static_cast<int>(low.x) + dx, relief.width());
    const uint32_t y = wrap(static_cast<int>(low.y) + dy, relief.height());
    sum += (dx ? part.x : 1 - part.x) * (dy ? part.y : 1 - part.y) * relief.heights()[y * relief.width() + x];
  }
  return sum;
}

/// By steps of a four-thousandth of the way from above the relief to below it.
Vec2 stepped(const Relief& relief, const Vec2& place, const Vec3& wv, float high, float aspect) {
  constexpr int kSteps = 4000;
  const Vec2 shift = Vec2(wv.x, wv.y / aspect) / wv.z;
  for (int i = 0; i <= kSteps; ++i) {
    const float z = high * (1 - 2.0f * static_cast<float>(i) / kSteps);
    const Vec2 at = place + z * shift;
    if (z <= height_at(relief, at)) return at;
  }
  return place - high * shift;
}

TEST(Relief, OfAPlaneIsTheParallaxOfItsHeight) {
  const Relief relief(4, 3, std::vector<float>(12, 0.25f), 2);
  EXPECT_TRUE(relief.flat());
  const Vec3 wv = towards(60, 30);
  const Vec2 seen = relief.seen({0.3f, 0.6f}, wv);
  EXPECT_NEAR(seen.x, 0.3f + 0.25f * std::tan(kPi / 3) * std::cos(kPi / 6), 1e-6f);
  EXPECT_NEAR(seen.y, 0.6f + 0.25f * std::tan(kPi / 3) * std::sin(kPi / 6) / 2, 1e-6f);
}

TEST(Relief, SeenFromTheNormalIsWhereItIs) {
  for (const Relief& relief : {random_relief(1, 8, 6, 0.4f, 1), sawtooth(16)}) {
    for (const Vec2& place : {Vec2(0.0f), Vec2(0.37f, 0.91f), Vec2(0.99f, 0.5f)}) {
      EXPECT_NEAR(glm::distance(relief.seen(place, {0, 0, 1}), place), 0.0f, 1e-6f);
    }
  }
}

/// The ridges at (k + 1/2 + 1/32) are 1/2 high, the grooves between them 0. A view of slope 1 / tan(theta) from the
/// right meets the side that looks to it at z = distance to the groove, where that is not hidden by the ridge.
TEST(Relief, OfASawtoothIsItsClosedForm) {
  const Relief relief = sawtooth(16);
  const float groove = 0.5f / 16;
  for (const float theta : {20.0f, 40.0f, 60.0f}) {
    const float slope = std::tan(theta * kPi / 180);
    const Vec3 wv = towards(theta, 0);
    for (int i = 0; i < 40; ++i) {
      const float x = groove + 0.025f * static_cast<float>(i);
      // The ray is at x + z slope; on the falling side of the ridge to the left, z = groove - x', beyond the groove,
      // z = x' - groove. Of both, and of their copies a tile on, the highest is what is met.
      float best = -1, expected = 0;
      for (int tile = -3; tile <= 3; ++tile) {
        const float to = groove + static_cast<float>(tile) - x;
        const float falling = to / (1 + slope), rising = slope == 1 ? -1 : -to / (1 - slope);
        for (const float z : {falling, rising}) {
          if (z < 0 || z > 0.5f || z <= best) continue;
          best = z;
          expected = x + z * slope;
        }
      }
      ASSERT_GE(best, 0);
      EXPECT_NEAR(relief.seen({x, 0.5f}, wv).x, expected, 1e-3f) << theta << ' ' << x;
    }
  }
}

/// The share of random views for which seen() and fine steps differ by more than `texels` of a texel and two steps.
double differing(const Relief& relief, float high, float aspect, float texels) {
  int differ = 0;
  constexpr int kCount = 200;
  for (uint64_t i = 0; i < kCount; ++i) {
    RandomStream random(20, i, 1);
    const Vec2 place = random.next2();
    const Vec3 wv = direction(1.3f * random.next(), 2 * kPi * random.next());
    const Vec2 step = 2 * high / 4000 * Vec2(wv.x, wv.y / aspect) / wv.z;
    const Vec2 apart = relief.seen(place, wv) - stepped(relief, place, wv, high, aspect);
    differ += glm::length(apart * Vec2(relief.width(), relief.height())) >
              texels + 2 * glm::length(step * Vec2(relief.width(), relief.height()));
  }
  return static_cast<double>(differ) / kCount;
}

TEST(Relief, OfJaggedGroovesIsWhatFineStepsFind) {
  const Relief along_x = random_relief(1, 13, 1, 0.2f, 1), along_y = random_relief(2, 1, 7, 0.2f, 0.6f);
  test::on_every_simd_target([&] {
    EXPECT_LE(differing(along_x, 0.2f, 1, 0.05f), 0.01);
    EXPECT_LE(differing(along_y, 0.2f, 0.6f, 0.05f), 0.01);
  });
}

/// Within a cell the surface is a chord: a hundredth of a texel.
TEST(Relief, OfHillsIsWhatFineStepsFindToAFractionOfATexel) {
  test::on_every_simd_target([&] {
    EXPECT_LE(differing(waves(32, 24, 0.1f, 1), 0.1f, 1, 0.05f), 0.01);
    EXPECT_LE(differing(waves(24, 40, 0.1f, 1.4f), 0.1f, 1.4f, 0.05f), 0.01);
  });
}

/// High enough that rays skip what no height reaches; sizes that squares of four cells do not divide.
TEST(Relief, OfHighHillsIsWhatFineStepsFind) {
  const Relief hills = waves(70, 45, 0.5f, 0.7f);
  test::on_every_simd_target([&] { EXPECT_LE(differing(hills, 0.5f, 0.7f, 0.25f), 0.02); });
}

TEST(Relief, EndsOnTheRelief) {
  const Relief relief = waves(32, 24, 0.1f, 1);
  for (uint64_t i = 0; i < 300; ++i) {
    RandomStream random(7, i, 1);
    const Vec2 place = random.next2();
    const Vec3 wv = direction(0.05f + 1.4f * random.next(), 2 * kPi * random.next());
    const Vec2 seen = relief.seen(place, wv);
    const Vec2 along = Vec2(wv.x, wv.y) / wv.z;
    const float z = glm::dot(seen - place, along) / glm::dot(along, along);
    EXPECT_NEAR(z, height_at(relief, seen), 2e-3f) << i;
    EXPECT_NEAR(glm::distance(place + z * along, seen), 0.0f, 1e-4f);
  }
}

TEST(Relief, Repeats) {
  const Relief relief = random_relief(9, 8, 8, 0.3f, 1);
  const Vec3 wv = towards(55, 200);
  const Vec2 seen = relief.seen({0.3f, 0.8f}, wv), further = relief.seen({2.3f, -1.2f}, wv);
  EXPECT_NEAR(glm::distance(further - seen, Vec2(2, -2)), 0.0f, 1e-5f);
}

/// Slopes below 1 / tan(theta) hide nothing: neighbors see neighbors.
TEST(Relief, IsContinuousWhereNothingIsHidden) {
  std::vector<float> heights;
  for (int i = 0; i < 32; ++i) heights.push_back(0.05f * std::sin(2 * kPi * static_cast<float>(i) / 32));
  const Relief relief(32, 1, heights, 1);
  const Vec3 wv = towards(60, 0);
  Vec2 before = relief.seen({0, 0.5f}, wv);
  for (int i = 1; i <= 2000; ++i) {
    const Vec2 seen = relief.seen({static_cast<float>(i) / 2000, 0.5f}, wv);
    EXPECT_LT(std::abs(seen.x - before.x), 2e-3f) << i;
    before = seen;
  }
}

TEST(Relief, HasTheSlopesOfItsNeighbors) {
  const Relief relief = sawtooth(16);
  EXPECT_NEAR(relief.slope(4, 0).x, -1.0f, 1e-5f);  // rising: the normal leans back
  EXPECT_NEAR(relief.slope(12, 0).x, 1.0f, 1e-5f);
  EXPECT_NEAR(relief.slope(0, 0).x, 0.0f, 1e-5f);  // the groove
  EXPECT_EQ(relief.slope(4, 0).y, 0.0f);
}

TEST(Relief, CutsItsSteepestSlopes) {
  const Relief relief = random_relief(3, 8, 8, 10, 1);
  bool cut = false;
  for (uint32_t t = 0; t < 64; ++t) {
    const float steepness = glm::length(relief.slope(t % 8, t / 8));
    EXPECT_LE(steepness, Relief::kSteepest * (1 + 1e-6f));
    cut |= steepness > 0.999f * Relief::kSteepest;
  }
  EXPECT_TRUE(cut);
}

TEST(Relief, IsFiniteAtTheHorizon) {
  const Relief relief = random_relief(5, 16, 16, 0.3f, 1);
  for (const float z : {1e-2f, 1e-3f, 1e-4f}) {
    for (const float phi : {0.0f, 0.7f, 3.0f}) {
      const float s = std::sqrt(1 - z * z);
      const Vec2 seen = relief.seen({0.2f, 0.4f}, {s * std::cos(phi), s * std::sin(phi), z});
      EXPECT_TRUE(std::isfinite(seen.x + seen.y)) << z;
    }
  }
}

}  // namespace
}  // namespace velour::relief_test
