#include "brdf/fit/parametric/warped_columns.h"

#include <gtest/gtest.h>

#include <cmath>

#include "brdf/fit/slice_sampling.h"

namespace velour::warped_columns_test {
namespace {

const Vec3d kView(std::sin(1.1), 0, std::cos(1.1));

SliceSamples samples_of_view() {
  std::vector<SliceSample> samples;
  const LightGrid grid = light_grid(Vec3(kView), 24, 16);
  for (size_t i = 0; i < grid.wl.size(); ++i)
    samples.push_back({grid.wl[i], 1 + 0.01f * static_cast<float>(i % 7), Rgb(1, 2, 3)});
  return SliceSamples(samples);
}

/// The column's formula by the scalar reference, in double.
double column(const WarpedShape& s, const SliceSamples& samples, size_t i) {
  const WarpedLobe lobe{s.space, stretch_from(s.stretch_a, s.stretch_b), tilted_normal(s.tilt_x, s.tilt_y),
                        std::exp(s.log_bandwidth), Vec3d(1)};
  const Vec3d wl = samples.wl(i);
  return static_cast<double>(samples.sqrt_weight()[i]) * wl.z * warped_kernel(lobe, wl, kView);
}

class WarpedColumns : public testing::TestWithParam<std::tuple<LobeSpace, double>> {
 protected:
  WarpedShape shape() const {
    return {std::get<0>(GetParam()), std::log(std::get<1>(GetParam())), -0.03, 0.02, 0.4, -0.2};
  }
  SliceSamples samples_ = samples_of_view();
};

TEST_P(WarpedColumns, ValuesFollowTheFormula) {
  AlignedFloats out(samples_.padded());
  fill_warped(shape(), kView, samples_, out.data());
  for (size_t i = 0; i < samples_.count(); ++i) {
    const double wanted = column(shape(), samples_, i);
    EXPECT_NEAR(out[i], wanted, 1e-6 + 1e-3 * wanted);
  }
  for (size_t i = samples_.count(); i < samples_.padded(); ++i) EXPECT_EQ(out[i], 0);
}

TEST_P(WarpedColumns, SlopesFollowCentralDifferences) {
  std::vector<AlignedFloats> columns(kWarpedSlopes, AlignedFloats(samples_.padded()));
  float* out[kWarpedSlopes];
  for (size_t a = 0; a < kWarpedSlopes; ++a) out[a] = columns[a].data();
  AlignedFloats value(samples_.padded()), alone(samples_.padded());
  fill_warped_slopes(shape(), kView, samples_, kWarpedSlopes, value.data(), out);
  fill_warped(shape(), kView, samples_, alone.data());
  EXPECT_EQ(value, alone);
  double WarpedShape::*const moved[kWarpedSlopes] = {&WarpedShape::log_bandwidth, &WarpedShape::tilt_x,
                                                     &WarpedShape::stretch_a, &WarpedShape::tilt_y,
                                                     &WarpedShape::stretch_b};
  constexpr double kStep = 1e-5;
  for (size_t a = 0; a < kWarpedSlopes; ++a) {
    WarpedShape up = shape(), down = shape();
    up.*moved[a] += kStep;
    down.*moved[a] -= kStep;
    const double scale = std::sqrt(std::exp(shape().log_bandwidth));
    for (size_t i = 0; i < samples_.count(); ++i) {
      const double slope = (column(up, samples_, i) - column(down, samples_, i)) / (2 * kStep);
      EXPECT_NEAR(out[a][i], slope, 2e-3 * scale) << a;
    }
  }
}

TEST_P(WarpedColumns, ProjectionsAreSumsOverTheColumn) {
  AlignedFloats value(samples_.padded());
  fill_warped(shape(), kView, samples_, value.data());
  const float* target[3] = {samples_.target(0), samples_.target(1), samples_.target(2)};
  const Projection p = project_warped(shape(), kView, samples_, target, 1);
  double moment = 0, norm_sq = 0;
  for (size_t i = 0; i < value.size(); ++i) {
    moment += static_cast<double>(value[i]) * target[1][i];
    norm_sq += static_cast<double>(value[i]) * value[i];
  }
  EXPECT_NEAR(p.moment[1], moment, 1e-5 * moment);
  EXPECT_NEAR(p.norm_sq, norm_sq, 1e-5 * norm_sq);
}

INSTANTIATE_TEST_SUITE_P(Shapes, WarpedColumns,
                         testing::Combine(testing::Values(LobeSpace::light, LobeSpace::half),
                                          testing::Values(0.05, 3.0, 200.0, 5000.0)));

}  // namespace
}  // namespace velour::warped_columns_test
