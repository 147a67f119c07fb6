#include "brdf/fit/per_view/slice_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "brdf/fit/slice_sampling.h"
#include "math/sphere/directions.h"

namespace velour::slice_fit_test {
namespace {

std::vector<SliceSample> lattice(int n, const Rgb& value) {
  std::vector<SliceSample> samples;
  for (const Vec3& w : hemisphere_fibonacci(n)) samples.push_back({w, 2 * kPi / static_cast<float>(n), value});
  return samples;
}

SliceFit fit(const std::vector<SliceSample>& samples, int max_lobes, double goal, Kernel kernel = Kernel::gaussian) {
  const Progress progress;
  return fit_slice(SliceSamples(samples), {kernel, max_lobes, goal}, progress).back();
}

void expect_sound(const SliceFit& fit) {
  EXPECT_TRUE(std::isfinite(fit.relative_l2));
  for (const SliceLobe& l : fit.lobes) {
    EXPECT_NEAR(glm::length(l.shape.center), 1, 1e-9);
    EXPECT_TRUE(std::isfinite(l.shape.sharpness) && l.shape.sharpness > 0);
    for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::isfinite(l.peak[c]) && l.peak[c] >= 0);
  }
}

TEST(SliceFit, BlackIsFittedWithoutLobes) {
  const SliceFit black = fit(lattice(500, Rgb(0)), 8, 0.01);
  EXPECT_TRUE(black.lobes.empty());
  EXPECT_EQ(black.relative_l2, 0);
}

TEST(SliceFit, OneBrightSampleGivesSoundLobes) {
  auto samples = lattice(500, Rgb(0));
  samples[123].value = Rgb(1000, 500, 100);
  for (const Kernel kernel : {Kernel::gaussian, Kernel::abel_poisson}) {
    const SliceFit one = fit(samples, 8, 0.01, kernel);
    expect_sound(one);
    EXPECT_LT(one.relative_l2, 1);
  }
}

TEST(SliceFit, ATailAtTheHorizonIsNotTheFootOfATower) {
  // Falls off the horizon like the tail of a lobe far below it; such a lobe would have a peak of e^20.
  auto samples = lattice(2000, Rgb(0));
  for (SliceSample& s : samples) {
    const float x = s.wl.x, z = s.wl.z;
    s.value = Rgb(std::exp(-40.0f * (x * -0.6f + z * 0.8f + 0.5f) - 20.0f));
  }
  float brightest = 0;
  for (const SliceSample& s : samples) brightest = std::max(brightest, s.value.g);
  const SliceFit tail = fit(samples, 8, 0.001);
  for (const SliceLobe& l : tail.lobes) EXPECT_LT(l.peak.g, 1000 * brightest);
}

/// Irregular samples of glossy materials leave such holes; models were ten million times too bright in them.
TEST(SliceFit, TheFlankOfAHoleIsNotTheFootOfATower) {
  const auto samples_outside = [](float most_z) {
    auto samples = lattice(2000, Rgb(0));
    for (SliceSample& s : samples) s.value = Rgb(std::exp(600.0f * (s.wl.z - 1)));
    std::erase_if(samples, [&](const SliceSample& s) { return s.wl.z > most_z; });
    return samples;
  };
  const auto peak = [](const SliceFit& fit) {
    double most = 0;
    for (const SliceLobe& l : fit.lobes) most = std::max(most, l.peak.g);
    return most;
  };
  EXPECT_LT(peak(fit(samples_outside(std::cos(0.17f)), 8, 0.001)), 20 * std::exp(600 * (std::cos(0.17) - 1)));
  EXPECT_GT(peak(fit(samples_outside(1), 8, 0.001)), 0.5) << "the control: without the hole";
}

TEST(SliceFit, FewSamplesGiveSoundLobes) {
  for (int n = 1; n < 8; ++n) expect_sound(fit(lattice(n, Rgb(1)), 16, 1e-6));
}

TEST(SliceFit, NegativeValuesGiveSoundLobes) {
  auto samples = lattice(500, Rgb(1, 0.5f, -0.1f));
  for (size_t i = 0; i < samples.size(); i += 7) samples[i].value = Rgb(-0.2f);
  expect_sound(fit(samples, 8, 0.01));
  expect_sound(fit(lattice(500, Rgb(-1)), 8, 0.01));
}

TEST(SliceFit, WhatNoFitCanFollowIsKnown) {
  std::vector<SliceSample> samples = lattice(800, Rgb(0));
  for (SliceSample& s : samples) s.value = Rgb(-0.1f, 0.5f, 0.2f) * s.wl.z;
  const SliceSamples slice(samples);
  const double expected = 0.2126 * 0.1 / luminance({-0.1f, 0.5f, 0.2f});
  EXPECT_NEAR(slice.gamut_error(), expected, 1e-5);
  EXPECT_NEAR(fit(samples, 8, 1e-9).relative_l2, expected, 1e-4);
}

TEST(SliceFit, ADiffuseSliceNeedsNoLobes) {
  std::vector<SliceSample> samples = lattice(2000, Rgb(0));
  for (SliceSample& s : samples) s.value = Rgb(s.wl.z);
  const SliceFit diffuse = fit(samples, 16, 0.02);
  EXPECT_LE(diffuse.relative_l2, 1e-6);
  EXPECT_TRUE(diffuse.lobes.empty());
}

TEST(SliceFit, ASharpHighlightIsFound) {
  const Vec3 wv = direction(radians_from(30.0f), 0);
  const Vec3d mirror(-wv.x, 0, wv.z);
  for (const double bandwidth : {1e3, 1e4, 1e5}) {
    const LightGrid grid = light_grid(wv);
    std::vector<SliceSample> samples;
    for (size_t i = 0; i < grid.wl.size(); ++i) {
      const double value = 100 * std::exp(-bandwidth * one_minus_dot(Vec3d(grid.wl[i]), mirror)) + 0.1;
      samples.push_back({grid.wl[i], grid.weight[i], Rgb(static_cast<float>(value))});
    }
    const SliceFit sharp = fit(samples, 4, 0.02);
    EXPECT_LE(sharp.relative_l2, 0.02) << bandwidth;
    const auto found = std::max_element(sharp.lobes.begin(), sharp.lobes.end(), [](const auto& a, const auto& b) {
      return a.shape.sharpness < b.shape.sharpness;
    });
    EXPECT_NEAR(found->shape.sharpness / bandwidth, 1, 0.05);
    EXPECT_LT(glm::distance(found->shape.center, mirror), 0.1 / std::sqrt(bandwidth));
  }
}

TEST(SliceFit, TheErrorNeverRisesAlongThePath) {
  std::vector<SliceSample> samples = lattice(1000, Rgb(0));
  for (SliceSample& s : samples) s.value = Rgb(std::pow(s.wl.z, 3.0f) + 0.5f * std::exp(-40 * (1 - s.wl.x)));
  const Progress progress;
  const auto path = fit_slice(SliceSamples(samples), {Kernel::gaussian, 12, 1e-5}, progress);
  EXPECT_EQ(path[0].lobes.size(), 0u);
  EXPECT_LT(path.back().relative_l2, 0.02);
  for (size_t j = 1; j < path.size(); ++j) {
    EXPECT_LE(path[j].relative_l2, path[j - 1].relative_l2);
    EXPECT_LE(path[j].lobes.size(), j);
  }
}

TEST(SliceFit, ACancelledFitStops) {
  Progress progress;
  progress.cancel();
  const SliceSamples samples(lattice(500, Rgb(1)));
  EXPECT_THROW(fit_slice(samples, {}, progress), Error);
}

}  // namespace
}  // namespace velour::slice_fit_test
