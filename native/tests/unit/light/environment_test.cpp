// The environment: where its pixels lie, that its density is what it samples and what it looks up.
#include "light/environment.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/error.h"
#include "light/equirectangular.h"
#include "math/sphere/random.h"
#include "math/sphere/warp.h"

namespace velour::environment_test {
namespace {

struct TestImage {
  int width, height;
  std::vector<float> rgb;
  TestImage(int w, int h) : width(w), height(h), rgb(3 * static_cast<size_t>(w) * static_cast<size_t>(h)) {}
  void set(int x, int y, const Rgb& c) {
    for (int k = 0; k < 3; ++k) rgb[3 * static_cast<size_t>(y * width + x) + static_cast<size_t>(k)] = c[k];
  }
  Environment environment(float strength = 1, const Mat3& turn = Mat3(1.0f)) const {
    return Environment::image({width, height, 3, rgb}, strength, turn);
  }
};

TestImage noise(int width, int height) {
  TestImage image(width, height);
  RandomStream random(4, 5, 6);
  for (float& v : image.rgb) v = std::pow(random.next(), 8.0f);
  return image;
}

double mass(const Environment& e, int n = 400000) {
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const float v = (static_cast<float>(i) + 0.5f) / static_cast<float>(n);
    const float u = std::fmod(static_cast<float>(i) * 0.618033988f, 1.0f);
    sum += e.pdf(sample_uniform_sphere({v, u}));
  }
  return sum * 4 * kPiD / n;
}

TEST(Environment, FollowsBlendersConvention) {
  TestImage image(8, 4);  // red rises with u, green with v from the bottom
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 8; ++x) {
      image.set(x, y, {(static_cast<float>(x) + 0.5f) / 8, 1 - (static_cast<float>(y) + 0.5f) / 4, 0});
    }
  }
  const Environment e = image.environment();
  // Rendered by Blender 3.4 (Cycles, Raw view): the middle column is +x, -y lies at u = 3/4, +z at the top.
  EXPECT_NEAR(e.radiance({1, 0, 0}).r, 0.5f, 1e-5f);
  EXPECT_NEAR(e.radiance({0, -1, 0}).r, 0.75f, 1e-5f);
  EXPECT_NEAR(e.radiance({0, 1, 0}).r, 0.25f, 1e-5f);
  EXPECT_NEAR(e.radiance({1, 0, 0}).g, 0.5f, 1e-5f);
  EXPECT_NEAR(e.radiance(direction(kPi / 4, 0.0f)).g, 0.75f, 1e-5f);
  EXPECT_NEAR(e.radiance({0, 0, 1}).g, 0.875f, 1e-5f);  // clamped at the pole
  EXPECT_NEAR(e.radiance({-1, 0, 0}).r, 0.5f, 1e-4f);   // wraps: halfway between 15/16 and 1/16
}

TEST(Environment, TurnAndStrength) {
  TestImage image(64, 32);
  for (int y = 0; y < 32; ++y) image.set(32, y, {1, 1, 1});          // a meridian just left of -y from +x
  const Mat3 quarter(Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1));  // +x to +y, +y to -x
  const Environment e = image.environment(3, quarter);
  EXPECT_NEAR(e.radiance({0, -1, 0}).r, 1.5f, 1e-3f);
  EXPECT_NEAR(e.radiance({1, 0, 0}).r, 0.0f, 1e-5f);
  for (int i = 0; i < 100; ++i) {
    const Vec3 w = e.sample({static_cast<float>(i) * 0.01f, 0.5f});
    EXPECT_LT(w.y, -0.9f);
  }
}

/// As if it had been read anew.
TEST(Environment, IsPlacedAnew) {
  const TestImage image = noise(32, 16);
  const Mat3 quarter(Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1));
  const Environment read = image.environment(3, quarter), placed = image.environment().placed(3, quarter);
  EXPECT_EQ(placed.mean_luminance(), read.mean_luminance());
  RandomStream random(7, 8, 9);
  for (int i = 0; i < 200; ++i) {
    const Vec2 u = random.next2();
    const Vec3 w = read.sample(u);
    EXPECT_EQ(placed.sample(u), w);
    EXPECT_EQ(placed.radiance(w).g, read.radiance(w).g);
    EXPECT_EQ(placed.pdf(w), read.pdf(w));
  }
  EXPECT_TRUE(placed.placed(0, quarter).black());
  EXPECT_TRUE(placed.placed(-1, quarter).black());
  EXPECT_EQ(placed.placed(-1, quarter).radiance({1, 0, 0}).r, 0);
  EXPECT_THROW(Environment::constant(Rgb(1.0f)).placed(1, quarter), Error);
  EXPECT_THROW(placed.placed(1, 2.0f * quarter), Error);
}

TEST(Environment, RowsMayBeginAtTheBottom) {
  const TestImage image = noise(8, 4);
  TestImage turned(8, 4);
  for (int y = 0; y < 4; ++y) std::copy_n(&image.rgb[24 * (3 - y)], 24, &turned.rgb[24 * y]);
  const Environment e = image.environment();
  const Environment same = Environment::image({8, 4, 3, turned.rgb, true}, 1, Mat3(1.0f));
  for (const Vec3& w : {Vec3(0, 0.6f, 0.8f), Vec3(0.6f, 0, -0.8f), Vec3(0, 0, 1)}) {
    EXPECT_EQ(e.radiance(w).r, same.radiance(w).r);
  }
}

TEST(Environment, CoordinatesMatchTheLibrary) {
  const Environment unused;
  const TestImage image(1024, 512);
  const EquirectangularImage table({1024, 512, 3, image.rgb});
  RandomStream random(1, 1, 1);
  double worst_u = 0, worst_v = 0;
  for (int round = 0; round < 400; ++round) {
    DirectionBatch batch;
    while (batch.count < 64) batch.push(sample_uniform_sphere(random.next2()));
    EquirectangularCoordinates at;
    equirectangular_coordinates(table, Mat3(1.0f), batch, at);
    for (int i = 0; i < 64; ++i) {
      const Vec3d d(batch.get(i));
      const double u = 0.5 - std::atan2(d.y, d.x) / (2 * kPiD), theta = std::acos(d.z / glm::length(d)) / kPiD;
      const double found_u = (at.x[i] + static_cast<double>(at.fx[i]) - 0.5) / 1024;
      const double gap = std::abs(found_u - u);
      worst_u = std::max(worst_u, std::min(gap, 1 - gap));
      worst_v = std::max(worst_v, std::abs((at.y[i] + static_cast<double>(at.fy[i]) - 0.5) / 512 - theta));
      EXPECT_TRUE(at.x[i] >= 0 && at.x[i] < 1024 && at.y[i] >= 0 && at.y[i] <= 512);
    }
  }
  EXPECT_LT(worst_u * 2 * kPiD, 8e-7);
  EXPECT_LT(worst_v * kPiD, 8e-7);
}

TEST(Environment, AxesAndPolesAreFinite) {
  const Environment e = noise(16, 8).environment();
  for (const Vec3& d : {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(-1, 0, 0), Vec3(-1, -0.0f, 0), Vec3(0, 1, 0)}) {
    EXPECT_TRUE(std::isfinite(e.pdf(d)) && std::isfinite(e.radiance(d).g));
    EXPECT_GE(e.pdf(d), 0);
  }
}

TEST(Environment, DensityIntegratesToOne) {
  EXPECT_NEAR(mass(noise(32, 16).environment()), 1, 2e-3);
  EXPECT_NEAR(mass(Environment::constant({1, 2, 3})), 1, 1e-6);
  TestImage flat(16, 8);
  std::fill(flat.rgb.begin(), flat.rgb.end(), 2.0f);
  EXPECT_NEAR(mass(flat.environment()), 1, 1e-3);
  EXPECT_NEAR(flat.environment().mean_luminance(), 2, 0.05);
}

TEST(Environment, DensityFollowsRadianceWithinTheSecondOrderBound) {
  // For a gray image the nodes differ from L sin(theta) only by the bilinear interpolation of sin(theta): away from the
  // poles by at most (pi / H)^2 / 8 relative to 1.
  TestImage image = noise(64, 32);
  for (size_t i = 0; i < image.rgb.size(); i += 3) {
    image.rgb[i] += 0.01f;
    image.rgb[i + 1] = image.rgb[i + 2] = image.rgb[i];
  }
  const Environment e = image.environment();
  double low = 1e30, high = 0;
  RandomStream random(3, 1, 4);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 d = sample_uniform_sphere(random.next2());
    if (std::abs(d.z) > 0.5f) continue;
    const double ratio = e.pdf(d) / luminance(e.radiance(d));
    low = std::min(low, ratio);
    high = std::max(high, ratio);
  }
  // Rows of unlike brightness tilt the weights: half a row's change of sin(theta) bounds that.
  EXPECT_LT(high / low - 1, 2 * kPiD / 32);
}

TEST(Environment, OneTexelSunIsAlwaysHit) {
  TestImage image(1024, 512);
  image.set(700, 100, {50000, 40000, 30000});
  const Environment e = image.environment();
  RandomStream random(9, 9, 9);
  double total = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 w = e.sample(random.next2());
    const float pdf = e.pdf(w);
    ASSERT_GT(pdf, 0);
    total += luminance(e.radiance(w)) / pdf;
  }
  EXPECT_NEAR(total / 20000 / (4 * kPiD * e.mean_luminance()), 1, 0.01);
}

/// What is even in (u, v) remains even in directions: u goes round once, v down, but for a row's height.
TEST(Environment, SampleIsMonotoneInItsNumbers) {
  constexpr int kHeight = 16;
  const Environment e = noise(2 * kHeight, kHeight).environment();
  const auto angle = [&](float u, float v) {
    const Vec3 w = e.sample({u, v});
    return Vec2(std::atan2(w.y, w.x), std::acos(std::clamp(w.z, -1.0f, 1.0f)));
  };
  float down = 0, azimuth = angle(0, 0.3f).x, turned = 0;
  for (int i = 0; i < 1000; ++i) {
    const float share = static_cast<float>(i) * 0.001f;
    const float theta = angle(0.25f, share).y, phi = angle(share, 0.3f).x;
    EXPECT_GE(theta, down - kPi / kHeight - 1e-3f);
    down = std::max(down, theta);
    const float step = std::remainder(phi - azimuth, 2 * kPi);
    EXPECT_LE(step, 1e-4f);
    turned += step;
    azimuth = phi;
  }
  EXPECT_GT(down, 0.9f * kPi);
  EXPECT_NEAR(turned, -2 * kPi, 0.1f);
}

TEST(Environment, BlackConstantAndHostileImages) {
  EXPECT_TRUE(Environment().black());
  EXPECT_TRUE(TestImage(8, 4).environment().black());
  EXPECT_FALSE(Environment::constant({0, 1, 0}).black());
  TestImage bad(2, 2);
  bad.rgb = {NAN, 1, 1, -5, 1, 1, INFINITY, 1, 1, 1, 1, 1};
  const Environment e = bad.environment();
  EXPECT_TRUE(std::isfinite(e.mean_luminance()));
  EXPECT_TRUE(std::isfinite(e.radiance({1, 0, 0}).r));
  EXPECT_THROW(Environment::image({2, 2, 2, bad.rgb}, 1, Mat3(1.0f)), Error);
  EXPECT_THROW(Environment::image({4, 2, 3, bad.rgb}, 1, Mat3(1.0f)), Error);
  EXPECT_THROW(bad.environment(NAN), Error);
  EXPECT_THROW(bad.environment(1, Mat3(2.0f)), Error);
}

}  // namespace
}  // namespace velour::environment_test
