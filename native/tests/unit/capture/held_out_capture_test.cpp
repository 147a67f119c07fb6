#include <gtest/gtest.h>

#include <cmath>

#include "btf/measure/pair_layout.h"
#include "support/captured.h"

namespace velour::held_out_capture_test {
namespace {

using test::Captured;
using test::small_capture;
using test::tile_of;

BtfCaptureOptions held_out_capture(uint32_t pairs) {
  BtfCaptureOptions options = small_capture({{0, 0}}, {{0, 0}});
  options.held_out = pairs;
  options.sampling.samples = 64;
  return options;
}

TEST(HeldOutCapture, IsWhatAFullCaptureSeesAtItsPairsWithOtherNoise) {
  const auto scene = tile_of(test::sawtooth(), std::make_shared<test::Lambert>(0.5f));
  constexpr uint32_t kPairs = 8;
  BtfCaptureOptions options = held_out_capture(kPairs);
  const Captured pairs(*scene, options, "held_out");
  EXPECT_EQ(pairs.report.pairs, kPairs);
  EXPECT_EQ(pairs.values.size(), kPairs * pairs.texels * 3);

  const PairLayout layout = held_out_pairs(kPairs, false);
  options.held_out = 0;
  options.views = layout.views();
  options.lights = layout.lights();
  const Captured full(*scene, options, "full");
  EXPECT_EQ(full.report.pairs, kPairs * kPairs);
  for (size_t i = 0; i < kPairs; ++i) {
    const test::Estimate of_pair = pairs.mean(i), same = full.mean(i * kPairs + i);
    EXPECT_NEAR(of_pair.mean, same.mean, 4 * std::hypot(of_pair.error, same.error)) << i;
    const bool noisy = same.error > 0;
    EXPECT_NE(noisy, of_pair.mean == same.mean) << "other random numbers: " << i;
  }
}

TEST(HeldOutCapture, LiesOnTheSamePlaneWhateverTheSeed) {
  const auto scene = tile_of(test::sawtooth(), std::make_shared<test::Lambert>(0.5f));
  BtfCaptureOptions options = held_out_capture(2);
  options.sampling.samples = 1;
  options.reference_height.reset();
  const double height = Captured(*scene, options, "seed_3").report.reference_height;
  options.held_out = 0;
  options.sampling.seed = 99;
  EXPECT_EQ(Captured(*scene, options, "seed_99").report.reference_height, height);
}

TEST(HeldOutCapture, OfAnOpenTileHasPairsOnBothSides) {
  const auto scene = tile_of(test::Corners().rectangle(0, 0, 1, 0.5f).mesh(), std::make_shared<test::Lambert>(0.5f));
  BtfCaptureOptions options = held_out_capture(32);
  options.sides = CaptureSides::automatic;
  options.sampling.samples = 1;
  const Captured captured(*scene, options, "open");
  EXPECT_TRUE(captured.report.two_sided);
  EXPECT_EQ(captured.report.pairs, 32u);
}

}  // namespace
}  // namespace velour::held_out_capture_test
