// The environment's sampler against the density that its look-up claims.
#include "light/environment.h"
#include "math/sphere/directions.h"
#include "math/sphere/random.h"
#include "support/sampler_proof.h"

namespace velour::environment_sampling_test {
namespace {

using test::Sampler;

struct Sky {
  const char* name;
  int width, height;
  float contrast;       // exponent of the noise: 0 is flat
  float sun = 0;        // radiance of a few texels
  bool turned = false;  // against the world
};

void PrintTo(const Sky& sky, std::ostream* out) { *out << sky.name; }

Mat3 turn() { return glm::transpose(Mat3({0.36f, 0.48f, -0.8f}, {-0.8f, 0.6f, 0}, {0.48f, 0.64f, 0.6f})); }

Environment environment(const Sky& sky, float sun) {
  const auto width = static_cast<size_t>(sky.width), height = static_cast<size_t>(sky.height);
  std::vector<float> rgb(3 * width * height);
  RandomStream random(4, 5, 6);
  for (float& v : rgb) v = std::pow(random.next(), sky.contrast);
  const size_t sun_texel = 3 * (height / 4 * width + width / 3);
  if (sun > 0) std::fill_n(&rgb[sun_texel], 3, sun);
  return Environment::image({sky.width, sky.height, 3, rgb}, 1, sky.turned ? turn() : Mat3(1.0f));
}

/// Cells about the sun's texel, in the world.
Sampler sampler_of(const Sky& sky, float sun) {
  const Environment e = environment(sky, sun);
  Sampler sampler{[e](const Vec2& u) { return e.sample(u); },
                  [e](const Vec3& w) { return static_cast<double>(e.pdf(w)); }};
  sampler.refinements = {1, 5};  // the density bends at every texel
  if (sun > 0) {
    const float u = (static_cast<float>(sky.width / 3) + 0.5f) / static_cast<float>(sky.width);
    const float v = (static_cast<float>(sky.height / 4) + 0.5f) / static_cast<float>(sky.height);
    const Vec3 in_image = direction(kPi * v, 2 * kPi * (0.5f - u));
    sampler.axis = sky.turned ? glm::transpose(turn()) * in_image : in_image;
    sampler.concentration = std::pow(static_cast<double>(sky.height), 2) / 10;  // of a texel
  }
  return sampler;
}

class EnvironmentSampling : public ::testing::TestWithParam<Sky> {};

TEST_P(EnvironmentSampling, FollowsItsDensity) {
  test::expect_proven(sampler_of(GetParam(), GetParam().sun), GetParam().name);
}

constexpr Sky kSkies[] = {{"one texel", 1, 1, 8},
                          {"odd size", 7, 3, 8},
                          {"flat", 16, 8, 0},
                          {"noise", 16, 8, 8},
                          {"noise, turned", 16, 8, 8, 0, true},
                          {"more texels than cells", 64, 32, 4},
                          {"sun of one texel", 128, 64, 1, 3e4f},
                          {"sun of a fraction of a degree, turned", 1024, 512, 1, 1e6f, true}};

INSTANTIATE_TEST_SUITE_P(All, EnvironmentSampling, ::testing::ValuesIn(kSkies));

TEST(EnvironmentSamplingControl, AnotherSunIsSeen) {
  const Sky& sky = kSkies[6];
  EXPECT_GT(test::p_value(sampler_of(sky, sky.sun), sampler_of(sky, sky.sun)), 1e-4);
  EXPECT_LT(test::p_value(sampler_of(sky, sky.sun), sampler_of(sky, 1.2f * sky.sun)), 1e-6);
}

TEST(EnvironmentSamplingControl, AnotherTurnIsSeen) {
  EXPECT_LT(test::p_value(sampler_of(kSkies[3], 0), sampler_of(kSkies[4], 0)), 1e-9);
}

/// Variance of the mean over 64 points of an irradiance, over that of 64 independent ones.
double variance_ratio(const Environment& sky, bool even_azimuth) {
  constexpr int kPoints = 64, kTrials = 400;
  const Vec3 normal = glm::normalize(Vec3(0.3f, -0.5f, 0.8f));
  const auto value = [&](const Vec2& u) {
    const Vec3 w = sky.sample(u);
    return static_cast<double>(luminance(sky.radiance(w)) / sky.pdf(w) * std::max(glm::dot(w, normal), 0.0f));
  };
  double mean = 0, square = 0, of_means = 0;
  for (uint64_t trial = 0; trial < kTrials; ++trial) {
    Vec2 points[kPoints];
    sobol_points(trial, 0, points);
    RandomStream random(trial, 1, 2);
    double sum = 0;
    for (Vec2& u : points) {
      if (!even_azimuth) u.x = random.next();
      const double v = value(u);
      sum += v / kPoints;
      square += v * v / (kPoints * kTrials);
    }
    mean += sum / kTrials;
    of_means += sum * sum / kTrials;
  }
  return (of_means - mean * mean) * kPoints / (square - mean * mean);
}

TEST(EnvironmentSamplingEvenness, PointsThatAreEvenGiveEvenDirections) {
  for (const Sky& sky : {kSkies[3], kSkies[5]}) {
    EXPECT_LT(variance_ratio(environment(sky, 0), true), 0.15) << sky.name;
    EXPECT_GT(variance_ratio(environment(sky, 0), false), 0.3) << sky.name;
  }
}

TEST(EnvironmentSamplingConstant, FollowsItsDensity) {
  const Environment e = Environment::constant({1, 2, 3});
  test::expect_proven(
      {[&](const Vec2& u) { return e.sample(u); }, [&](const Vec3& w) { return static_cast<double>(e.pdf(w)); }},
      "constant");
}

}  // namespace
}  // namespace velour::environment_sampling_test
