#include "btf/fit/svd/svd_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "unit/btf/fit/factored_fits.h"

namespace velour::view_svd_fit_test {
namespace {

using test::errors_of;
using test::kGrid;
using test::noise;
using test::small_layout;

test::FactoredFit fit_view_svd(const BtfMeasurement& btf, const BtfFitOptions& options) {
  return test::fit<ViewSvdFitter>(btf, options);
}

uint64_t bytes_of(size_t components, const BtfMeasurement& btf) {
  return components * 2 * (btf.layout().lights().size() + pyramid_texels(btf.grid()));
}

/// Square of a product for each view, one color.
Rgb squared_product_of_view(const DirectionPair& pair, uint32_t x, uint32_t y) {
  const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
  const float product = (1.2f + pair.wl.x) * (1.5f + std::sin(20 * pair.wv.x * fx + 30 * pair.wv.y * fy));
  return 0.1f * product * product * Rgb(1.0f, 0.5f, 0.25f);
}

TEST(ViewSvdFit, RecoversAProductOfEachViewToTheRoundingOfHalves) {
  const test::MemoryBtf btf(small_layout(), kGrid, squared_product_of_view);
  const test::FactoredFit found = fit_view_svd(btf, {.bytes = bytes_of(5, btf)});
  EXPECT_EQ(found.btf.view, (std::vector<uint16_t>{0, 1, 2, 3, 4}));
  EXPECT_EQ(found.btf.pair_value.size(), 5u * 7u);
  EXPECT_LT(errors_of(found.btf, btf).ser, 1e-6);
  // The control: without its component a view is black.
  EXPECT_GT(errors_of(fit_view_svd(btf, {.bytes = bytes_of(4, btf)}).btf, btf).ser, 0.1);
}

/// The squares of singular values of every view's matrices.
std::vector<double> energies(const BtfMeasurement& btf, const Mat3& axes) {
  const auto lights = static_cast<Eigen::Index>(btf.layout().lights().size());
  const auto texels = static_cast<Eigen::Index>(btf.grid().texels());
  const std::vector<float> f = test::values_of(btf);
  std::vector<double> energy;
  for (uint64_t v = 0; v < btf.layout().views().size(); ++v) {
    for (int a = 0; a < 3; ++a) {
      const auto first = static_cast<Eigen::Index>(btf.layout().first(v));
      test::add_energies(test::plane_of(f, axes[a], first, lights, texels), energy);
    }
  }
  return energy;
}

TEST(ViewSvdFit, LeavesWhatTheDenseDecompositionOfEachViewDoes) {
  const test::MemoryBtf btf(small_layout(), kGrid, noise);
  for (const size_t components : {20u, 50u}) {
    const test::FactoredFit found =
        fit_view_svd(btf, {.bytes = bytes_of(components, btf), .companding = Companding::none});
    ASSERT_EQ(found.btf.components(), components);
    const double left = test::left_out(energies(btf, found.btf.axes), components);
    const double error = test::squared_error(found.btf, btf);
    EXPECT_LT(error, 1.001 * left);
    EXPECT_GT(error, 0.95 * left) << "sums below 0 are clamped, which helps a little";
  }
}

TEST(ViewSvdFit, ItsCurveIsTheErrorOfEverySize) {
  const test::MemoryBtf btf(small_layout(), kGrid, noise);
  Progress progress;
  FitCheckpoint none;
  ViewSvdFitter fitter(btf, {.bytes = bytes_of(60, btf)}, none, progress);
  ASSERT_EQ(fitter.curve().points.size(), 60u);
  for (const size_t point : {30u, 59u}) {
    const BtfErrors errors = errors_of(std::get<FactoredBtf>(fitter.fit(point)), btf);
    EXPECT_NEAR(errors.relative_l2, fitter.curve().points[point].relative_l2, 0.02) << point;
  }
}

TEST(ViewSvdFit, EachViewIsAsBrightAsWhatItLeavesOut) {
  const test::MemoryBtf btf(small_layout(), kGrid, noise);
  const test::FactoredFit found = fit_view_svd(btf, {.bytes = bytes_of(15, btf)});
  ASSERT_EQ(std::set(found.btf.view.begin(), found.btf.view.end()).size(), 5u);
  EXPECT_NEAR(errors_of(found.btf, btf).brightness, 1, 2e-3);
}

TEST(ViewSvdFit, OfABlackBtfIsBlack) {
  const test::MemoryBtf btf(small_layout(), kGrid, [](const DirectionPair&, uint32_t, uint32_t) { return Rgb(0.0f); });
  const test::FactoredFit found = fit_view_svd(btf, {.bytes = 9000});
  std::vector<float> image;
  FactoredImages(found.btf).image(btf.layout().directions(3), image);
  for (const float f : image) EXPECT_EQ(f, 0.0f);
}

}  // namespace
}  // namespace velour::view_svd_fit_test
