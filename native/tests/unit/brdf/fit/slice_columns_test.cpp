#include "brdf/fit/slice_columns.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/simd.h"
#include "brdf/fit/per_view/slice_fit.h"
#include "math/sphere/directions.h"
#include "unit/brdf/fit/shape_value.h"

namespace velour::slice_columns_test {
namespace {

using test::shape_value;

SliceSamples unit_samples(int n) {
  std::vector<SliceSample> samples;
  for (const Vec3& w : hemisphere_fibonacci(n)) samples.push_back({w, 1.0f, Rgb(1, 2, 3)});
  return SliceSamples(samples);
}

/// Centers that floats hold exactly: their rounding is not what is tested here.
LobeShape shape_at(const Vec3& direction, double sharpness) {
  return {Vec3d(glm::normalize(direction)), static_cast<float>(sharpness)};
}

class SliceColumns : public testing::TestWithParam<std::tuple<Kernel, double>> {
 protected:
  Kernel kernel() const { return std::get<0>(GetParam()); }
  LobeShape shape() const { return shape_at({0.3f, -0.2f, 0.9f}, std::get<1>(GetParam())); }
  SliceSamples samples_ = unit_samples(1000);
};

TEST_P(SliceColumns, ValuesFollowTheFormula) {
  AlignedFloats out(samples_.padded());
  fill_value(kernel(), shape(), samples_, out.data());
  for (size_t i = 0; i < samples_.count(); ++i) {
    EXPECT_NEAR(out[i], shape_value(kernel(), shape(), samples_.wl(i)), 1e-6);
  }
}

TEST_P(SliceColumns, DerivativesFollowCentralDifferences) {
  AlignedFloats x(samples_.padded()), y(x), k(x);
  fill_derivatives(kernel(), shape(), samples_, x.data(), y.data(), k.data());
  const LobeTangents t = lobe_tangents(shape());
  const double e = 1e-5, turn = e / std::sqrt(shape().sharpness);
  const auto difference = [&](const LobeShape& above, const LobeShape& below, const Vec3d& w) {
    return (shape_value(kernel(), above, w) - shape_value(kernel(), below, w)) / (2 * e);
  };
  const auto moved = [&](const Vec3d& by) { return LobeShape{glm::normalize(shape().center + by), shape().sharpness}; };
  const LobeShape sharper{shape().center, shape().sharpness * std::exp(e)};
  const LobeShape broader{shape().center, shape().sharpness * std::exp(-e)};
  for (size_t i = 0; i < samples_.count(); ++i) {
    const Vec3d w = glm::normalize(samples_.wl(i));
    EXPECT_NEAR(x[i], difference(moved(turn * t.x), moved(-turn * t.x), w), 1e-6);
    EXPECT_NEAR(y[i], difference(moved(turn * t.y), moved(-turn * t.y), w), 1e-6);
    EXPECT_NEAR(k[i], difference(sharper, broader, w), 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Kernels, SliceColumns,
                         testing::Combine(testing::Values(Kernel::gaussian, Kernel::abel_poisson),
                                          testing::Values(0.05, 1.0, 30.0, 1000.0)));

TEST(StoredLobe, IsTheSameFunctionInTheModelsTerms) {
  for (const Kernel kernel : {Kernel::gaussian, Kernel::abel_poisson}) {
    for (const double sharpness : {0.05, 1.0, 30.0, 1e3, 1e5}) {
      const SliceLobe lobe{shape_at({0.3f, -0.2f, 0.9f}, sharpness), Vec3d(2, 1, 0.5)};
      const StoredLobe stored = stored_lobe(kernel, lobe);
      for (const double width : {0.0, 0.3, 1.0, 3.0}) {
        const double d = std::min(1.9, width / sharpness);
        const double kd = sharpness * d;
        const double expected = kernel == Kernel::gaussian ? std::exp(-kd) : std::pow(1 + 2.0 / 3.0 * kd, -1.5);
        const double value = stored.coefficient.r * kernel_value(kernel, stored.bandwidth, d);
        EXPECT_NEAR(value, 2 * expected, 1e-4 * expected) << kernel_name(kernel) << ' ' << sharpness << ' ' << width;
      }
    }
  }
}

TEST(SliceColumnProducts, EqualDoublePrecisionSums) {
  const SliceSamples samples = unit_samples(777);  // not a multiple of a vector
  ColumnSet columns(samples.padded());
  columns.resize(7);  // nor of a tile
  for (size_t j = 0; j < 7; ++j) {
    const double sharpness = std::pow(3.0, static_cast<double>(j));
    fill_value(Kernel::gaussian, shape_at({0.1f * static_cast<float>(j), 0.2f, 0.7f}, sharpness), samples, columns[j]);
  }
  const auto pointers = columns.first(7);
  Eigen::MatrixXd products, crossed;
  gram(pointers, samples.padded(), products);
  cross_gram(columns.first(3), pointers, samples.padded(), crossed);
  for (Eigen::Index i = 0; i < 7; ++i) {
    for (Eigen::Index j = 0; j < 7; ++j) {
      double sum = 0;
      for (size_t s = 0; s < samples.count(); ++s) {
        sum += static_cast<double>(columns[static_cast<size_t>(i)][s]) * columns[static_cast<size_t>(j)][s];
      }
      EXPECT_NEAR(products(i, j), sum, 2e-6 * std::sqrt(products(i, i) * products(j, j)));
      if (i < 3) {
        EXPECT_NEAR(crossed(i, j), sum, 2e-6 * std::sqrt(products(i, i) * products(j, j)));
      }
    }
  }
}

TEST(SliceColumnProducts, ProjectionIsTheDotProductWithTheColumn) {
  const SliceSamples samples = unit_samples(333);
  const LobeShape shape = shape_at({0.5f, 0.1f, 0.6f}, 20);
  AlignedFloats column(samples.padded());
  fill_value(Kernel::gaussian, shape, samples, column.data());
  const float* const residual[3] = {samples.target(0), samples.target(1), samples.target(2)};
  const Projection p = project(Kernel::gaussian, shape, samples, residual);
  double sum = 0, norm_sq = 0;
  for (size_t i = 0; i < samples.count(); ++i) sum += column[i], norm_sq += column[i] * column[i];
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(p.moment[c], (c + 1) * sum, 1e-5 * sum * (c + 1));
  EXPECT_NEAR(p.norm_sq, norm_sq, 1e-5 * norm_sq);
}

TEST(SliceColumnProducts, InstructionSetsAgree) {
  const SliceSamples samples = unit_samples(500);
  const LobeShape shape = shape_at({0.2f, -0.6f, 0.7f}, 50);
  AlignedFloats best(samples.padded());
  fill_value(Kernel::gaussian, shape, samples, best.data());
  for (const std::string& target : simd_targets()) {
    ASSERT_TRUE(select_simd_target(target.c_str()));
    AlignedFloats out(samples.padded());
    fill_value(Kernel::gaussian, shape, samples, out.data());
    for (size_t i = 0; i < out.size(); ++i) EXPECT_NEAR(out[i], best[i], 1e-6) << target;
  }
  select_simd_target("auto");
}

}  // namespace
}  // namespace velour::slice_columns_test
