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

}  // namespace
}  // namespace velour::irregular_samples_test
