#include "btf/fit/svd/svd_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "btf/fit/btf_fit.h"
#include "support/warnings.h"
#include "unit/btf/fit/factored_fits.h"

namespace velour::svd_fit_test {
namespace {

using test::errors_of;
using test::kGrid;
using test::noise;
using test::small_layout;

test::FactoredFit fit_svd(const BtfMeasurement& btf, const BtfFitOptions& options) {
  return test::fit<SvdFitter>(btf, options);
}

double error_of(const FactoredBtf& model, const BtfMeasurement& btf) { return errors_of(model, btf).ser; }

/// Square of a sum of three products, one color: three components of one axis.
Rgb squared_products(const DirectionPair& pair, uint32_t x, uint32_t y) {
  const auto fx = static_cast<float>(x), fy = static_cast<float>(y);
  const float sum = 1.0f + pair.wl.x * 0.1f * fx + pair.wv.y * pair.wl.y * 0.2f * std::sin(fy + fx);
  return 0.1f * sum * sum * Rgb(1.0f, 0.5f, 0.25f);
}

TEST(SvdFit, RecoversAProductsSquareToTheRoundingOfHalves) {
  const test::MemoryBtf btf(small_layout(), kGrid, squared_products);
  const test::FactoredFit found = fit_svd(btf, {.bytes = 4 * 2 * (btf.layout().pairs() + pyramid_texels(kGrid))});
  EXPECT_EQ(found.btf.components(), 4u);
  EXPECT_LT(error_of(found.btf, btf), 1e-6);
  // The control: three products are not two.
  EXPECT_GT(error_of(fit_svd(btf, {.bytes = 2 * 2 * (btf.layout().pairs() + pyramid_texels(kGrid))}).btf, btf), 1e-4);
}

TEST(SvdFit, IsAsBrightAsWhatItLeavesOut) {
  const test::MemoryBtf btf(small_layout(), kGrid, noise);
  const uint64_t bytes = 6 * 2 * (btf.layout().pairs() + pyramid_texels(kGrid));
  const BtfErrors errors = errors_of(fit_svd(btf, {.bytes = bytes}).btf, btf);
  EXPECT_NEAR(errors.brightness, 1, 2e-3);
  EXPECT_GT(errors.ser, 0.1) << "the control: most of the spread of the roots, a ninth of their mean square, is lost";
}

TEST(SvdFit, LosesNoMoreThanTheExactDecomposition) {
  const test::MemoryBtf btf(small_layout(), kGrid, noise);
  const auto pairs = static_cast<Eigen::Index>(btf.layout().pairs());
  const auto texels = static_cast<Eigen::Index>(kGrid.texels());
  const test::FactoredFit found =
      fit_svd(btf, {.bytes = 30 * 2 * (btf.layout().pairs() + pyramid_texels(kGrid)), .companding = Companding::none});
  const std::vector<float> f = test::values_of(btf);
  std::vector<double> energy;
  for (int a = 0; a < 3; ++a) {
    test::add_energies(test::plane_of(f, found.btf.axes[a], 0, pairs, texels), energy);
  }
  // Noise has the slowest spectrum there is; clamping at 0 only helps.
  EXPECT_LT(test::squared_error(found.btf, btf), 1.03 * test::left_out(energy, 30));
}

TEST(SvdFit, IsNotPulledByEntriesThatAreNotFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const test::MemoryBtf btf(small_layout(), kGrid, [&](const DirectionPair& pair, uint32_t x, uint32_t y) {
    return x == 3 && y == 4 && pair.wl.x > 0 ? Rgb(nan) : squared_products(pair, x, y);
  });
  const test::FactoredFit found = fit_svd(btf, {.bytes = 6000});
  EXPECT_GT(found.not_finite, 0u);
  EXPECT_LT(error_of(found.btf, btf), 1e-3);
}

TEST(SvdFit, DirectionsThatAreThereTwiceAreTold) {
  CompressOptions options;
  options.method = CompressMethod::svd;
  const auto warnings = [&](const std::vector<PolarAngles>& views) {
    const test::MemoryBtf btf({views, ring_directions(50, 7)}, kGrid, squared_products);
    Progress progress;
    return compress_btf(btf, options, progress).btf->warnings;
  };
  EXPECT_TRUE(warnings({{0, 0}, {30, 0}, {30, 120}, {30, 240}}).empty());
  const auto told = warnings({{0, 0}, {0, 90}, {30, 0}, {30, 120}, {30, 240}});
  EXPECT_EQ(told,
            std::vector{warning<WarningCode::repeated_directions>({{"views", uint64_t{1}}, {"lights", uint64_t{0}}})});
}

}  // namespace
}  // namespace velour::svd_fit_test
