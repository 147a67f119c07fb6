#include "brdf/fit/parametric/view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "brdf/measure/held_out.h"

namespace velour::sample_spacing_test {
namespace {

/// A view's own lights, with a highlight about the normal (of half vectors) over `base`.
struct Lights {
  std::shared_ptr<const DirectionTree> tree;
  std::vector<SliceSample> samples;
};

Lights lights_of(const Vec3& wv, float peak, float base, float bandwidth = 500) {
  const LightReader read = [=](std::span<const Vec3> wl, std::span<LightValue> values) {
    for (size_t i = 0; i < wl.size(); ++i) {
      const Vec3 h = glm::normalize(wl[i] + wv);
      const float across = 0.5f * (h.x * h.x + h.y * h.y);
      values[i] = {.f = Rgb(base + peak * std::exp(-bandwidth * across)), .valid = true};
    }
  };
  Lights out{std::make_shared<const DirectionTree>(read, wv, 256), {}};
  for (const uint32_t i : out.tree->leaves()) {
    const DirectionTree::Cell& cell = out.tree->cell(i);
    out.samples.push_back({cell.wl, static_cast<float>(cell.solid_angle()), cell.value.f});
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
  const SampleSpacing spacing(lights_of(Vec3(wv), 100, 1, 5e4f).tree, wv);
  EXPECT_LT(spacing.excess({LobeSpace::half, std::log(5e4)}), 0);
  EXPECT_GT(spacing.excess(light_lobe(1e4, 75, 0)), 0);
}

/// Share of the integral of `shape` that the samples see, one in eight of them held out.
double seen(const WarpedShape& shape, const std::vector<SliceSample>& samples, const Vec3d& wv) {
  const WarpedLobe lobe{shape.space, stretch_from(shape.stretch_a, shape.stretch_b),
                        tilted_normal(shape.tilt_x, shape.tilt_y), std::exp(shape.log_bandwidth), Vec3d(1)};
  double sum = 0, all = 0;
  for (size_t i = 0; i < samples.size(); ++i) {
    const double value = warped_kernel(lobe, Vec3d(samples[i].wl), wv);
    if (!held_out_light(i)) sum += static_cast<double>(samples[i].weight) * value * value;
  }
  const LightReader read = [&](std::span<const Vec3> wl, std::span<LightValue> values) {
    for (size_t i = 0; i < wl.size(); ++i) {
      values[i] = {.f = Rgb(static_cast<float>(warped_kernel(lobe, Vec3d(wl[i]), wv)) / wl[i].z), .valid = true};
    }
  };
  const DirectionTree own(read, Vec3(wv), 1024);
  for (const uint32_t i : own.leaves()) {
    all += own.cell(i).solid_angle() * own.cell(i).luminance_cos() * own.cell(i).luminance_cos();
  }
  return sum / all;
}

// A fit put a lobe three times as bright as a vinyl's highlight a sixth of a degree beside it, between the samples.
TEST(SampleSpacing, ALobeOfTheLeastWidthMeetsSamplesEverywhere) {
  for (const float theta_v : {20.0f, 60.0f}) {
    const Vec3d wv = Vec3d(direction(radians_from(theta_v), 0.0f));
    const Lights lights = lights_of(Vec3(wv), 100, 0.3f, 5e4f);
    const SampleSpacing spacing(lights.tree, wv);
    for (const double degrees : {0.0, 0.1, 0.15, 0.3, 0.6, 1.0, 2.0, 5.0, 15.0}) {
      for (const double stretch : {-0.5, 0.0, 0.5}) {
        WarpedShape shape{LobeSpace::half, 0, degrees * kPiD / 180, 0, stretch, 0};
        shape.log_bandwidth = -spacing.excess(shape);
        EXPECT_NEAR(spacing.excess(shape), 0, 1e-6);
        EXPECT_GT(seen(shape, lights.samples, wv), 0.1) << theta_v << ' ' << degrees << ' ' << stretch;
      }
    }
  }
}

// What such a lobe shows of itself is a rim that falls off within 1 / (bandwidth sin(depth)), with a coefficient that
// makes up for its depth: a fit put errors of eighty times the material there.
TEST(SampleSpacing, ALobeBelowTheHorizonMayNotRiseBetweenTheSamplesAndTheHorizon) {
  const Vec3 wv = direction(radians_from(60.0f), 0.0f);
  const Lights lights = lights_of(wv, 1, 1);
  const SampleSpacing spacing(lights.tree, Vec3d(wv));
  EXPECT_GT(spacing.excess(light_lobe(100, 150, 2)), 0);
  EXPECT_LT(spacing.excess(light_lobe(1, 150, 2)), 0);
  for (const double theta : {92.0, 100.0, 120.0, 150.0}) {
    const double bandwidth = std::exp(-spacing.excess(light_lobe(1, theta, 2)));
    const double rim = 1 / (bandwidth * -std::cos(theta * kPiD / 180));  // radians
    const auto met = std::ranges::count_if(lights.samples, [&](const SliceSample& s) {
      const double azimuth = std::atan2(static_cast<double>(s.wl.y), static_cast<double>(s.wl.x));
      return std::abs(azimuth - 2) < 0.25 && static_cast<double>(s.wl.z) < 2 * rim;
    });
    EXPECT_GT(met, 0) << theta;
  }
}

TEST(SampleSpacing, SlopesAreThoseOfTheExcess) {
  const Vec3 wv = direction(radians_from(60.0f), 0.0f);
  const SampleSpacing spacing(lights_of(wv, 1, 1).tree, Vec3d(wv));
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

TEST(PictureWeights, TakeEveryBrightnessByItsRatio) {
  const auto samples = lights_of({0, 0, 1}, 1000, 1).samples;
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

TEST(PictureWeights, BlackHasNone) { EXPECT_TRUE(picture_weights(lights_of({0, 0, 1}, 0, 0).samples).empty()); }

}  // namespace
}  // namespace velour::sample_spacing_test
