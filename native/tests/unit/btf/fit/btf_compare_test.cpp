#include "btf/fit/btf_compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/memory_btf.h"

namespace velour::btf_compare_test {
namespace {

const TexelGrid kComparedGrid{4, 2};

PairLayout few_pairs() { return {ring_directions(30, 3), ring_directions(60, 4)}; }

TEST(BtfCompare, MeasuresAKnownDifference) {
  const test::MemoryBtf btf(few_pairs(), kComparedGrid, [](auto&&...) { return Rgb(0.5f); });
  const auto darker = [](const DirectionPair&, std::vector<float>& rgb) {
    rgb.assign(kComparedGrid.texels() * 3, 0.25f);
  };
  Progress progress;
  const BtfErrors errors = compare_btf(btf, darker, {.p99 = 0.5}, 1, progress);
  EXPECT_NEAR(errors.ser, 0.25, 1e-12);
  EXPECT_NEAR(errors.relative_l2, 1 - std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(compare_btf(btf, darker, {.p99 = 0.5, .companding = Companding::none}, 1, progress).relative_l2, 0.5,
              1e-12);
  EXPECT_NEAR(errors.brightness, 0.5, 1e-12);
  const double seen = 1.0 - (1.055 * std::pow(0.5, 1 / 2.4) - 0.055);
  EXPECT_NEAR(errors.psnr, -20 * std::log10(seen), 1e-4);
  EXPECT_EQ(errors.pairs, 12u);
}

TEST(BtfCompare, LeavesOutWhatIsNotFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const test::MemoryBtf btf(few_pairs(), kComparedGrid,
                            [&](const DirectionPair&, uint32_t x, uint32_t) { return x == 0 ? Rgb(nan) : Rgb(0.5f); });
  const auto same = [](const DirectionPair&, std::vector<float>& rgb) { rgb.assign(kComparedGrid.texels() * 3, 0.5f); };
  Progress progress;
  const BtfErrors errors = compare_btf(btf, same, {.p99 = 0.5}, 1, progress);
  EXPECT_EQ(errors.ser, 0.0);
  EXPECT_EQ(errors.brightness, 1.0);
}

TEST(BtfCompare, FindsThePercentile) {
  uint32_t count = 0;  // 96 values of each channel, rising
  const test::MemoryBtf btf(few_pairs(), kComparedGrid, [&](auto&&...) { return Rgb(static_cast<float>(count++)); });
  EXPECT_EQ(percentile_99(btf, Progress()), 95.0);  // 0.99 x 96 = 95.04: the last
  const test::MemoryBtf flat(few_pairs(), kComparedGrid, [](auto&&...) { return Rgb(-1.0f, 0.25f, 0.25f); });
  EXPECT_EQ(percentile_99(flat, Progress()), 0.25);
}

/// Errors are divided by it: they would be no numbers.
TEST(BtfCompare, APercentileIsNeverZero) {
  uint32_t count = 0;
  const auto one_bright = [&](auto&&...) { return Rgb(count++ == 5 ? 3.0f : 0.0f, 0.0f, 0.0f); };
  EXPECT_EQ(percentile_99(test::MemoryBtf(few_pairs(), kComparedGrid, one_bright), Progress()), 3.0);
  const test::MemoryBtf black(few_pairs(), kComparedGrid, [](auto&&...) { return Rgb(0.0f); });
  EXPECT_EQ(percentile_99(black, Progress()), 1.0);
}

}  // namespace
}  // namespace velour::btf_compare_test
