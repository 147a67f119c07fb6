// What irregular samples tell of highlights.
#include "brdf/measure/irregular_samples.h"

#include <gtest/gtest.h>

#include <cmath>

#include "math/sphere/directions.h"

namespace velour::irregular_samples_test {
namespace {

constexpr float kWidest = radians_from(75.0f);

/// A highlight of `width` radians over a diffuse base, at lights from 10 to 70 degrees and views in the plane of the
/// light, `step` radians apart, the first half a step from the mirror direction.
std::vector<IrregularSample> in_plane(float width, float step) {
  std::vector<IrregularSample> samples;
  for (int light = 1; light <= 7; ++light) {
    const float theta_l = radians_from(10.0f * static_cast<float>(light));
    for (float theta_v = theta_l - 6.8f * step; theta_v < std::min(theta_l + 7.0f * step, kWidest); theta_v += step) {
      const float tilt = 0.5f * (theta_v - theta_l);
      const float value = 0.01f + 5.0f * std::exp(-tilt * tilt / (width * width));
      samples.push_back({direction(theta_l, 0), direction(std::abs(theta_v), theta_v > 0 ? kPi : 0), Rgb(value)});
    }
  }
  return samples;
}

TEST(UnresolvedHighlights, AreSeenWithTheirGap) {
  const float step = radians_from(8.0f);
  const double gap = gap_of_unresolved_highlights(in_plane(radians_from(0.8f), step));
  EXPECT_GT(gap, 0.3 * static_cast<double>(step));
  EXPECT_LT(gap, static_cast<double>(step));
}

TEST(UnresolvedHighlights, WidthsThatSamplesShowAreNot) {
  EXPECT_EQ(gap_of_unresolved_highlights(in_plane(radians_from(8.0f), radians_from(8.0f))), 0.0);
  EXPECT_EQ(gap_of_unresolved_highlights(in_plane(radians_from(0.8f), radians_from(1.5f))), 0.0);
}

TEST(UnresolvedHighlights, MatteSurfacesHaveNone) {
  EXPECT_EQ(gap_of_unresolved_highlights(in_plane(10.0f, radians_from(8.0f))), 0.0);
  EXPECT_EQ(gap_of_unresolved_highlights({}), 0.0);
}

/// Samples at random directions of a diffuse material with a highlight of `width` radians.
std::vector<IrregularSample> scattered(size_t count, double width) {
  const auto directions = hemisphere_fibonacci(static_cast<int>(2 * count));
  std::vector<IrregularSample> samples;
  for (size_t i = 0; i < count; ++i) {
    const Vec3 wl = directions[i], wv = directions[(i * 7919 + 1) % directions.size()];
    const double theta_h = half_diff(wl, wv).theta_h;
    samples.push_back({wl, wv, Rgb(static_cast<float>(0.1 + 20 * std::exp(-theta_h * theta_h / (width * width))))});
  }
  return samples;
}

TEST(Spikes, AreLeftOut) {
  auto samples = scattered(800, 0.3);
  const auto clean = samples;
  for (const size_t i : {50u, 300u, 555u}) samples[i].f *= 300.0f;
  const auto kept = without_spikes(samples);
  EXPECT_GE(samples.size() - kept.size(), 2u);
  EXPECT_LE(samples.size() - kept.size(), 3u);
  for (const IrregularSample& s : kept) EXPECT_LE(s.f.r, 300 * 0.11f);
  EXPECT_EQ(without_spikes(clean).size(), clean.size());
}

TEST(Spikes, HighlightsAreNone) {
  for (const double width : {0.01, 0.03, 0.1, 0.3}) {
    const auto samples = scattered(600, width);
    EXPECT_EQ(without_spikes(samples).size(), samples.size()) << width;
  }
  EXPECT_EQ(without_spikes(in_plane(radians_from(0.8f), radians_from(1.5f))).size(),
            in_plane(radians_from(0.8f), radians_from(1.5f)).size());
}

}  // namespace
}  // namespace velour::irregular_samples_test
