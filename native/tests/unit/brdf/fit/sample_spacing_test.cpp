#include "brdf/fit/parametric/sample_spacing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "brdf/fit/parametric/view.h"
#include "brdf/fit/view_grid.h"

namespace velour {
namespace {

/// A view's own lights, with an f cos that has a highlight about `center` (of half vectors) over `base`.
std::vector<SliceSample> lights_of(const Vec3& wv, float peak, float base) {
  const LightGrid grid = light_grid(wv, 64, 32);
  std::vector<SliceSample> out;
  for (size_t i = 0; i < grid.wl.size(); ++i) {
    const Vec3 h = glm::normalize(grid.wl[i] + wv);
    out.push_back({grid.wl[i], grid.weight[i], Rgb(base + peak * std::exp(500 * (h.z - 1)))});
  }
  return out;
}

/// A round lobe of light space about the direction (theta in degrees, phi).
WarpedShape light_lobe(double bandwidth, double theta, double phi) {
  const double tilt = theta * kPiD / 180;
  return {LobeSpace::light, std::log(bandwidth), tilt * std::cos(phi), tilt * std::sin(phi)};
}

TEST(SampleSpacing, HighlightsMayBeSharpAndWhatIsFarFromThemMayNot) {
  const Vec3d wv = Vec3d(direction(radians_from(75.0f), 0.0f));
  const SampleSpacing spacing(lights_of(Vec3(wv), 1, 1), wv);
  EXPECT_LT(spacing.excess({LobeSpace::half, std::log(1e5)}), 0);
  EXPECT_GT(spacing.excess(light_lobe(1e3, 75, 0)), 0);
}

// Near the mirror direction samples crowd from one degree to the next, and the spacing is that of the finest.
TEST(SampleSpacing, FarFromTheMirrorDirectionALobeOfTheLeastWidthMeetsSamples) {
  const Vec3d wv = Vec3d(direction(radians_from(40.0f), 0.0f));
  const auto samples = lights_of(Vec3(wv), 1, 1);
  const SampleSpacing spacing(samples, wv);
  for (const float theta : {10.0f, 30.0f, 60.0f, 80.0f}) {
    for (const float phi : {0.3f, 0.9f, 1.3f, 1.7f}) {
      const Vec3d center = Vec3d(direction(radians_from(theta), phi));
      const double bandwidth = std::exp(-spacing.excess(light_lobe(1, theta, phi)));
      const auto seen = [&](double sharpness) {
        double sum = 0;
        for (const SliceSample& s : samples) {
          sum += static_cast<double>(s.weight) * std::exp(sharpness * (glm::dot(Vec3d(s.wl), center) - 1));
        }
        return sum * sharpness / (2 * kPiD);  // 1 when the samples tell the lobe's integral
      };
      EXPECT_GT(seen(bandwidth), 0.05) << theta << " " << phi;
    }
  }
}

// What such a lobe shows of itself is a rim that falls off within 1 / (bandwidth sin(depth)), with a coefficient that
// makes up for its depth: a fit put errors of eighty times the material there.
TEST(SampleSpacing, ALobeBelowTheHorizonMayNotRiseBetweenTheSamplesAndTheHorizon) {
  const Vec3 wv = direction(radians_from(60.0f), 0.0f);
  const auto samples = lights_of(wv, 1, 1);
  const SampleSpacing spacing(samples, Vec3d(wv));
  EXPECT_GT(spacing.excess(light_lobe(100, 150, 2)), 0);
  EXPECT_LT(spacing.excess(light_lobe(1, 150, 2)), 0);
  for (const double theta : {92.0, 100.0, 120.0, 150.0}) {
    const double bandwidth = std::exp(-spacing.excess(light_lobe(1, theta, 2)));
    const double rim = 1 / (bandwidth * -std::cos(theta * kPiD / 180));  // radians
    const auto met = std::count_if(samples.begin(), samples.end(), [&](const SliceSample& s) {
      const double azimuth = std::atan2(static_cast<double>(s.wl.y), static_cast<double>(s.wl.x));
      return std::abs(azimuth - 2) < 0.25 && static_cast<double>(s.wl.z) < 2 * rim;
    });
    EXPECT_GT(met, 0) << theta;
  }
}

TEST(SampleSpacing, IsContinuousAcrossItsCellsAndTheHorizon) {
  const Vec3 wv = direction(radians_from(60.0f), 0.0f);
  const SampleSpacing spacing(lights_of(wv, 1, 1), Vec3d(wv));
  double most = 0;
  for (double theta = 60; theta < 120; theta += 0.01) {
    const double step = spacing.excess(light_lobe(30, theta + 0.01, 2)) - spacing.excess(light_lobe(30, theta, 2));
    most = std::max(most, std::abs(step));
  }
  EXPECT_LT(most, 0.02);
}

TEST(SampleSpacing, SlopesAreThoseOfTheExcess) {
  const Vec3 wv = direction(radians_from(60.0f), 0.0f);
  const SampleSpacing spacing(lights_of(wv, 1, 1), Vec3d(wv));
  WarpedShape shape = light_lobe(50, 100, 2);
  shape.stretch_a = 0.3, shape.stretch_b = -0.2;
  Eigen::VectorXd slope(kWarpedSlopes);
  spacing.slopes(shape, slope);
  WarpedShape moved = shape;
  constexpr double kStep = 1e-3;
  moved.log_bandwidth += kStep, moved.tilt_x -= 2 * kStep, moved.tilt_y += kStep;
  moved.stretch_a += 3 * kStep, moved.stretch_b -= kStep;
  const double expected = kStep * (slope[0] - 2 * slope[1] + 3 * slope[2] + slope[3] - slope[4]);
  EXPECT_NEAR(spacing.excess(moved) - spacing.excess(shape), expected, 0.02 * std::abs(expected));
}

TEST(SampleSpacing, NothingIsAskedWhereThereAreNoSamples) {
  const Vec3d wv(0, 0, 1);
  EXPECT_LT(SampleSpacing({}, wv).excess({LobeSpace::light, 50}), 0);
}

TEST(PictureWeights, TakeEveryBrightnessByItsRatio) {
  const auto samples = lights_of({0, 0, 1}, 1000, 1);
  const std::vector<float> weight = picture_weights(samples);
  ASSERT_EQ(weight.size(), samples.size());
  double sum = 0, dim = 0, square = 0, dim_square = 0;
  for (size_t i = 0; i < samples.size(); ++i) {
    const double w = static_cast<double>(samples[i].weight), y = static_cast<double>(luminance(samples[i].value));
    const double part = w * static_cast<double>(weight[i]) * y * y;
    const bool is_dim = y < 10;
    sum += part, square += w * y * y;
    if (is_dim) dim += part, dim_square += w * y * y;
  }
  EXPECT_NEAR(sum, 1, 1e-4);
  EXPECT_GT(dim, 0.5);                    // most directions are dim
  EXPECT_LT(dim_square, 0.001 * square);  // and count for nothing in the squared error
}

TEST(PictureWeights, BlackHasNone) { EXPECT_TRUE(picture_weights(lights_of({0, 0, 1}, 0, 0)).empty()); }

}  // namespace
}  // namespace velour
