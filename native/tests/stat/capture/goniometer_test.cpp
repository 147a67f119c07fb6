// The goniometer against what is known of Gaussian surfaces. Every test has a control that must fail.
#include "capture/goniometer/goniometer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "support/beckmann.h"
#include "support/statistics.h"

namespace velour::goniometer_test {
namespace {

GoniometerOptions options_for(double roughness) {
  GoniometerOptions options;
  options.surface.roughness = roughness;
  options.facets = Reflectance({0.0, 1.0});  // lossless
  options.seed = 20;
  options.batches = 16;
  options.tiles_per_batch = 2;
  options.samples_per_tile = 40'000;
  return options;
}

/// A run, and what it amounts to with all batches and with one batch alone.
struct Measured {
  explicit Measured(const GoniometerOptions& o)
      : options(o), bins(o), batches(run_goniometer(o, progress)), brdf(o, bins, total()) {}

  GoniometerSums total() const {
    GoniometerSums sums(bins);
    for (const GoniometerSums& batch : batches) sums += batch;
    return sums;
  }
  /// Mean and spread over the batches of a number taken from one of them.
  test::RunningMean over_batches(const std::function<double(const MicrosurfaceBrdf&)>& number) const {
    test::RunningMean mean;
    for (const GoniometerSums& batch : batches) mean.add(number(MicrosurfaceBrdf(options, bins, batch)));
    return mean;
  }

  GoniometerOptions options;
  GoniometerBins bins;
  Progress progress;
  std::vector<GoniometerSums> batches;
  MicrosurfaceBrdf brdf;
};

/// Relative L2 distance of the measured single reflection from Beckmann's of `alpha`, over the highlights of views up
/// to 60 degrees: lights up to 12 degrees off the mirror direction.
double distance_from_beckmann(const MicrosurfaceBrdf& brdf, double alpha) {
  double difference = 0, norm = 0;
  for (int view = 0; view <= 60; view += 10) {
    const Vec3 wv = direction(radians_from(static_cast<float>(view)), 0);
    for (int tilt = -12; tilt <= 12; tilt += 2) {
      for (const float aside : {0.0f, 0.08f, 0.16f}) {
        const float theta = radians_from(static_cast<float>(view + tilt));
        const Vec3 wl = glm::normalize(Vec3(-std::sin(theta), aside, std::cos(theta)));
        const double expected = test::beckmann(alpha, {wl, wv});
        difference += std::pow(static_cast<double>(brdf.single({wl, wv}).g) / expected - 1, 2);
        norm += 1;
      }
    }
  }
  return std::sqrt(difference / norm);
}

TEST(Goniometer, SingleReflectionIsBeckmannsWithSmithMasking) {
  for (const double alpha : {0.1, 0.2}) {
    const Measured measured(options_for(alpha));
    EXPECT_LT(distance_from_beckmann(measured.brdf, alpha), 0.025) << alpha;
    EXPECT_GT(distance_from_beckmann(measured.brdf, 1.1 * alpha), 0.1) << "control: a roughness 10 % off";
  }
}

TEST(Goniometer, WhatSingleReflectionLosesComesBackFromMore) {
  const Measured measured(options_for(0.6));
  for (const float view : {0.0f, 30.0f, 60.0f, 75.0f}) {
    const Vec3 wv = direction(radians_from(view), 0.3f);
    const auto part = [&](auto member) {
      return measured.over_batches(
          [&](const MicrosurfaceBrdf& b) { return static_cast<double>(albedo(b, member, wv, 4000).g); });
    };
    const test::RunningMean all = part(&MicrosurfaceBrdf::f), single = part(&MicrosurfaceBrdf::single);
    // Nothing is lost: 1 up to the noise and up to 0.6 % that bins of finite width smear across the horizon.
    EXPECT_NEAR(all.mean(), 1, 0.006 + 4 * all.standard_error()) << view;
    // Control: single reflection alone does lose light.
    EXPECT_LT(single.mean() + 10 * single.standard_error(), 0.97) << view;
  }
}

TEST(Goniometer, ADiffuseBaseUnderLosslessMetalLosesNothingEither) {
  GoniometerOptions options = options_for(0.4);
  options.base_share = 0.5;
  options.base_albedo = Rgb(1, 0.5f, 0);
  const Measured measured(options);
  for (const float view : {0.0f, 45.0f, 70.0f}) {
    const Vec3 wv = direction(radians_from(view), 1.0f);
    const Rgb seen = albedo(measured.brdf, &MicrosurfaceBrdf::f, wv, 10'000);
    EXPECT_NEAR(seen.r, 1, 0.01) << view;
    EXPECT_LT(seen.g, 0.85f) << view;  // control: an absorbing base
    EXPECT_LT(seen.b, seen.g - 0.15f) << view;
  }
}

/// Sum of z^2 of f(a, b) - f(b, a) over pairs of directions, and their number, in a run that was not made reciprocal.
/// `favour` multiplies f where the light is the steeper direction.
std::pair<double, int> reciprocity_chi_sq(const Measured& measured, double favour) {
  double chi_sq = 0;
  int count = 0;
  for (const float theta_a : {0.2f, 0.6f, 0.9f}) {
    for (const float theta_b : {1.1f, 1.3f}) {
      for (const float phi : {0.5f, 1.6f, 2.6f}) {
        const Vec3 a = direction(theta_a, 0), b = direction(theta_b, phi);
        const test::RunningMean difference = measured.over_batches([&](const MicrosurfaceBrdf& brdf) {
          return static_cast<double>(brdf.diffuse({a, b}).g) * favour - static_cast<double>(brdf.diffuse({b, a}).g);
        });
        chi_sq += std::pow(difference.mean() / difference.standard_error(), 2);
        ++count;
      }
    }
  }
  return {chi_sq, count};
}

TEST(Goniometer, LightTakesTheSamePathBothWays) {
  GoniometerOptions options = options_for(0.5);
  options.reciprocal = false;
  options.base_share = 0.7;
  options.base_albedo = Rgb(0.8f);
  const Measured measured(options);
  const auto [chi_sq, count] = reciprocity_chi_sq(measured, 1.0);
  EXPECT_LT(chi_sq, count + 4 * std::sqrt(2.0 * count));
  EXPECT_GT(reciprocity_chi_sq(measured, 1.1).first, count + 8 * std::sqrt(2.0 * count)) << "control: 10 % one way";
}

/// How far facets are from pointing evenly in all azimuths: relative difference of the highlight's tails along x and
/// along y.
double stretch(const MicrosurfaceBrdf& brdf, const HeightFieldOptions& surface) {
  const float alpha = static_cast<float>(surface.roughness);
  const auto at = [&](float phi) {
    return static_cast<double>(brdf.single({direction(3.0f * alpha, phi), {0, 0, 1}}).g);
  };
  return (at(0) - at(0.5f * kPi)) / (at(0) + at(0.5f * kPi));
}

TEST(Goniometer, SquareCellsDoNotShowInTheAzimuth) {
  // Bins that keep both azimuths, over a surface that is isotropic but for a trifle.
  GoniometerOptions options = options_for(0.2);
  options.surface.anisotropy = 1.0000001;
  EXPECT_NEAR(stretch(Measured(options).brdf, options.surface), 0, 0.04);
  options.surface.anisotropy = 1.1;
  EXPECT_GT(stretch(Measured(options).brdf, options.surface), 0.12) << "control: a tenth rougher along x";
}

TEST(Goniometer, DependsOnNeitherThreadsNorOrder) {
  GoniometerOptions options = options_for(0.3);
  options.batches = 4;
  options.tiles_per_batch = 1;
  options.samples_per_tile = 5000;
  Progress progress;
  options.threads = 1;
  const auto one = run_goniometer(options, progress);
  options.threads = 4;
  const auto four = run_goniometer(options, progress);
  for (size_t b = 0; b < one.size(); ++b) {
    EXPECT_EQ(one[b].metal_facets, four[b].metal_facets);
    EXPECT_EQ(one[b].clear, four[b].clear);
    EXPECT_EQ(one[b].tried, four[b].tried);
    EXPECT_EQ(one[b].metal_flux, four[b].metal_flux);
    EXPECT_EQ(one[b].rays, four[b].rays);
  }
}

TEST(Goniometer, HardlyAnyPathIsLost) {
  GoniometerOptions options = options_for(1.0);
  options.batches = 4;
  const Measured measured(options);
  EXPECT_LT(static_cast<double>(measured.total().lost), 1e-3 * measured.total().samples);
}

}  // namespace
}  // namespace velour::goniometer_test
