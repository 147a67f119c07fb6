#include "btf/fit/svd/svd_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "base/error.h"
#include "support/striped_btf.h"
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
}

std::set<uint16_t> views_of(const FactoredBtf& btf) { return {btf.view.begin(), btf.view.end()}; }

/// Sparse noise, of which no component has most; 20 times darker at grazing views.
Rgb dark_beyond_60_degrees(const DirectionPair& pair, uint32_t x, uint32_t y) {
  return (pair.wv.z < 0.5f ? 0.05f : 1.0f) * glm::pow(noise(pair, x, y), Rgb(8.0f));
}

/// The strongest components of all views belong to the bright ones.
TEST(ViewSvdFit, DarkViewsHaveAComponentBesideBrightOnes) {
  const test::MemoryBtf btf(test::ringed_layout(), kGrid, dark_beyond_60_degrees);
  const size_t views = btf.layout().views().size();
  for (const size_t components : {views, views + 3}) {
    const FactoredBtf found = fit_view_svd(btf, {.bytes = bytes_of(components, btf)}).btf;
    EXPECT_EQ(found.components(), components);
    EXPECT_EQ(views_of(found).size(), views);
  }
  // The control: a black view needs none.
  const test::MemoryBtf black(test::ringed_layout(), kGrid, [](const DirectionPair& pair, uint32_t x, uint32_t y) {
    return (pair.wv.z < 0.5f ? 0.0f : 1.0f) * noise(pair, x, y);
  });
  EXPECT_EQ(views_of(fit_view_svd(black, {.bytes = bytes_of(views, btf)}).btf).size(), views - 8);
}

TEST(ViewSvdFit, RefusesSizesThatLeaveViewsBlackAndNamesTheSmallestThatDoesNot) {
  const test::MemoryBtf btf(test::ringed_layout(), kGrid, dark_beyond_60_degrees);
  try {
    fit_view_svd(btf, {.bytes = bytes_of(14, btf) - 1});
    ADD_FAILURE() << "not refused";
  } catch (const Error& refused) {
    EXPECT_EQ(refused.status(), Status::invalid_argument);
    const std::string smallest =
        "One component for each of the 14 views that are not black takes " + std::to_string(bytes_of(14, btf));
    EXPECT_NE(std::string(refused.what()).find(smallest), std::string::npos) << refused.what();
  }
  EXPECT_EQ(fit_view_svd(btf, {.bytes = bytes_of(14, btf)}).btf.components(), 14u);
}

TEST(ViewSvdFit, SmallestModelWithinAToleranceHasAComponentForEveryView) {
  const test::MemoryBtf btf(test::ringed_layout(), kGrid, dark_beyond_60_degrees);
  Progress progress;
  FitCheckpoint none;
  ViewSvdFitter fitter(btf, {.tolerance = 0.9}, none, progress);
  ASSERT_EQ(fitter.curve().points.front().lobes, 14);
  EXPECT_EQ(views_of(std::get<FactoredBtf>(fitter.fit(0))).size(), 14u);
}

/// A two-hundredth of so small a BTF, the usual size, is fewer components than views.
TEST(ViewSvdFit, TheDefaultSizeHasAComponentForEveryView) {
  const test::MemoryBtf btf(test::ringed_layout(), kGrid, squared_product_of_view);
  const FactoredBtf found = fit_view_svd(btf, {}).btf;
  EXPECT_EQ(views_of(found).size(), btf.layout().views().size());
  EXPECT_LT(errors_of(found, btf).ser, 1e-6);
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
  ASSERT_EQ(fitter.curve().points.size(), 56u) << "from one for each of five views on";
  for (const size_t point : {26u, 55u}) {
    const BtfErrors errors = errors_of(std::get<FactoredBtf>(fitter.fit(point)), btf);
    EXPECT_NEAR(errors.relative_l2, fitter.curve().points[point].relative_l2, 0.02) << point;
  }
}

TEST(ViewSvdFit, EachViewIsAsBrightAsWhatItLeavesOut) {
  const test::MemoryBtf btf(small_layout(), kGrid, noise);
  const test::FactoredFit found = fit_view_svd(btf, {.bytes = bytes_of(15, btf)});
  ASSERT_EQ(views_of(found.btf).size(), 5u);
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
