#include "btf/fit/srbf/srbf_fit.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

#include "btf/fit/btf_compare.h"
#include "btf/fit/relief_pyramid.h"
#include "btf/model/srbf_evaluator.h"
#include "image/texels.h"
#include "math/sphere/random.h"
#include "support/example_srbf.h"
#include "support/fitted_btfs.h"
#include "support/striped_btf.h"

namespace velour::srbf_fit_test {
namespace {

constexpr uint64_t kSrbfBytes = 3000;

struct SrbfFit {
  SrbfBtf btf;
  uint64_t not_finite;
};

/// Setting up is the first half of the progress.
SrbfFit fit_srbf(const BtfMeasurement& btf, const BtfFitOptions& options, Progress& progress) {
  FitCheckpoint none;
  std::optional<SrbfFitter> fitter;
  {
    const Progress::Span setup(progress, 0, 0.5);
    fitter.emplace(btf, options, none, progress);
  }
  const Progress::Span fitting(progress, 0.5, 1);
  return {std::get<SrbfBtf>(fitter->fit(fitter->largest())), fitter->not_finite()};
}

SrbfFit fit_srbf(const BtfMeasurement& btf, const BtfFitOptions& options) {
  Progress progress;
  return fit_srbf(btf, options, progress);
}

std::shared_ptr<const SrbfBtf> shared(SrbfBtf btf) { return std::make_shared<const SrbfBtf>(std::move(btf)); }

TexelGrid small_grid() { return {12, 8, Vec2(0.003f, 0.002f)}; }

/// Smooth over the tile, which repeats.
std::vector<float> smooth(const SrbfLevel& level, size_t channels, float mean, float swing) {
  std::vector<float> value;
  for (size_t t = 0; t < size_t{level.width} * level.height; ++t) {
    const float x = 2 * kPi * static_cast<float>(t % level.width) / static_cast<float>(level.width);
    const float y = 2 * kPi * static_cast<float>(t / level.width) / static_cast<float>(level.height);
    for (size_t k = 0; k < channels; ++k) {
      const auto phase = static_cast<float>(k);
      value.push_back(mean + swing * std::sin(x + phase) * std::cos(y - 2 * phase));
    }
  }
  return value;
}

/// A model over a plane, or over hills of `high` widths of the tile, 12 x 8 texels.
SrbfBtf true_srbf(float high, bool two_sided = false) {
  SrbfBtf btf = test::example_srbf(two_sided);
  btf.layout = test::ringed_layout(two_sided);
  btf.grid = small_grid();
  for (SrbfSide& side : btf.sides) {
    const bool below = side.view_below;
    side = test::example_side(12, 8, below);
    std::vector<std::vector<float>> values;
    for (SrbfLevel& level : side.levels) {
      floats_to_halves(smooth(level, 1, 0, high), level.relief);
      values.push_back(smooth(level, side.coefficients(), below ? 0.2f : 0.3f, 0.2f));
    }
    side.set_scale(values);
    side.set_values(values);
  }
  return btf;
}

test::MemoryBtf images_of(const SrbfBtf& model) {
  const SrbfEvaluator evaluator(shared(model));
  return test::shown_by(model.layout, model.grid,
                        [&](const DirectionPair& pair, std::vector<float>& rgb) { srbf_image(evaluator, pair, rgb); });
}

test::MemoryBtfWithRelief with_relief(const SrbfBtf& model, bool hole = false) {
  std::vector<float> heights(model.grid.texels());
  halves_to_floats(model.sides[0].levels[0].relief, heights);
  return test::over_relief(images_of(model), heights, hole);
}

BtfErrors errors_of(const SrbfBtf& model, const BtfMeasurement& btf) {
  const SrbfEvaluator evaluator(shared(model));
  const auto decode = [&](const DirectionPair& pair, std::vector<float>& rgb) { srbf_image(evaluator, pair, rgb); };
  Progress progress;
  return compare_btf(btf, decode, {percentile_99(btf, progress)}, 2, progress);
}

void expect_same(const SrbfBtf& a, const SrbfBtf& b) {
  ASSERT_EQ(a.sides.size(), b.sides.size());
  for (size_t s = 0; s < a.sides.size(); ++s) {
    const SrbfSide &one = a.sides[s], &two = b.sides[s];
    EXPECT_EQ(one.lobe, two.lobe);
    EXPECT_EQ(one.tile_lobes, two.tile_lobes);
    ASSERT_EQ(one.lobes.size(), two.lobes.size());
    for (size_t j = 0; j < one.lobes.size(); ++j) EXPECT_EQ(one.lobes[j].light, two.lobes[j].light);
    ASSERT_EQ(one.levels.size(), two.levels.size());
    for (size_t l = 0; l < one.levels.size(); ++l) {
      EXPECT_EQ(one.levels[l].value, two.levels[l].value);
      EXPECT_EQ(one.levels[l].relief, two.levels[l].relief);
    }
  }
}

/// Lobes are searched for, not given: a model recovers another one to a PSNR, not to its rounding.
TEST(SrbfFit, RecoversABtfThatIsAModelOverAPlane) {
  const test::MemoryBtf btf = images_of(true_srbf(0));
  EXPECT_GT(errors_of(fit_srbf(btf, {.bytes = 10000}).btf, btf).psnr, 38);
  // The control: one lobe is not enough.
  EXPECT_LT(errors_of(fit_srbf(btf, {.bytes = 600}).btf, btf).psnr, 30);
}

/// As few lobes as find a relief's model do not find what depends on the phase angle as well.
SrbfBtf without_phases(SrbfBtf btf) {
  for (SrbfSide& side : btf.sides) {
    for (MultivariateLobe& lobe : side.lobes) lobe.phase = 0;
  }
  return btf;
}

TEST(SrbfFit, RecoversABtfThatIsAModelOverARelief) {
  constexpr float kHigh = 0.09f;  // a ray at 60 degrees is displaced by up to two texels
  const test::MemoryBtfWithRelief btf = with_relief(without_phases(true_srbf(kHigh)));
  EXPECT_GT(errors_of(fit_srbf(btf, {.bytes = 3050}).btf, btf).psnr, 35);
  // The control: the same without its relief.
  const test::MemoryBtf flat = images_of(without_phases(true_srbf(kHigh)));
  EXPECT_LT(errors_of(fit_srbf(flat, {.bytes = 3050}).btf, flat).psnr, 26);
}

TEST(SrbfFit, KeepsToItsBytes) {
  const test::MemoryBtf btf = test::striped_btf(small_grid());
  for (const uint64_t bytes : {600, 3000}) {
    const SrbfBtf model = fit_srbf(btf, {.bytes = bytes}).btf;
    EXPECT_LE(model.parameter_bytes(), bytes);
    EXPECT_GT(model.parameter_bytes(), bytes / 2);
  }
}

TEST(SrbfFit, IsAsBrightAsWhatItLeavesOut) {
  uint64_t entry = 0;
  const auto noise = [&entry](auto&&...) { return Rgb(0.5f, 0.3f, 0.2f) * RandomStream(7, entry++, 0).next(); };
  const test::MemoryBtf btf(test::ringed_layout(), small_grid(), noise);
  const BtfErrors errors = errors_of(fit_srbf(btf, {.bytes = 2000}).btf, btf);
  EXPECT_NEAR(errors.brightness, 1, 0.01);
  EXPECT_GT(errors.ser, 0.1) << "the control: most of the spread of the roots, a ninth of their mean square, is lost";
}

TEST(SrbfFit, RefusesTooFewBytesWithASentence) {
  test::expect_refused(Status::invalid_argument, "the maximum size is 100 bytes",
                       [] { fit_srbf(test::striped_btf(small_grid()), {.bytes = 100}); });
}

TEST(SrbfFit, NeedsEveryPair) {
  const PairLayout holes(ring_directions(30, 2), ring_directions(50, 2), {{0, 1}, {0}});
  test::expect_refused(Status::unsupported, "3 view-light pairs",
                       [&] { fit_srbf(test::MemoryBtf(holes, small_grid(), test::striped), {}); });
}

TEST(SrbfFit, IsTheSameForAnyNumberOfThreads) {
  const test::MemoryBtf btf = test::striped_btf(small_grid());
  const SrbfBtf one = fit_srbf(btf, {.bytes = kSrbfBytes, .threads = 1}).btf,
                two = fit_srbf(btf, {.bytes = kSrbfBytes, .threads = 2}).btf;
  expect_same(one, two);
}

TEST(SrbfFit, IsFlatWithoutStructure) {
  const SrbfBtf model = fit_srbf(test::striped_btf(small_grid()), {.bytes = kSrbfBytes}).btf;
  ASSERT_EQ(model.sides.size(), 1u);
  for (const SrbfLevel& level : model.sides[0].levels) {
    for (const HalfBits h : level.relief) EXPECT_EQ(h, 0);
  }
  EXPECT_EQ(model.sides[0].levels.back().width, 1u);
  EXPECT_EQ(model.sides[0].levels.back().height, 1u);
}

TEST(SrbfFit, HasTheReliefOfTheStructure) {
  const SrbfBtf truth = true_srbf(0.05f);
  const test::MemoryBtfWithRelief btf = with_relief(truth, true);
  const std::vector<Relief> pyramid = relief_pyramid(btf, sides_of(btf.layout()).at(0));
  ASSERT_EQ(pyramid.size(), 4u);  // 12 x 8, 6 x 4, 3 x 2, 1 x 1
  std::vector<float> expected(truth.grid.texels());
  halves_to_floats(truth.sides[0].levels[0].relief, expected);
  EXPECT_NEAR(pyramid[0].heights()[0], -0.1f, 1e-4f);  // no hit: the lowest point of the shell
  double mean[2] = {0, 0};
  for (size_t t = 0; t < expected.size(); ++t) {
    if (t > 0) {
      EXPECT_NEAR(pyramid[0].heights()[t], expected[t], 1e-4f);
    }
    mean[0] += static_cast<double>(pyramid[0].heights()[t]) / 96;
  }
  for (const float h : pyramid[1].heights()) mean[1] += static_cast<double>(h) / 24;
  EXPECT_NEAR(mean[0], mean[1], 1e-4);
}

/// Reflection from both sides, and none through: the bytes are those of two sides.
TEST(SrbfFit, OfTwoSidesFitsBoth) {
  const SrbfBtf truth = true_srbf(0, true);
  const test::MemoryBtf btf = images_of(truth);
  const SrbfBtf model = fit_srbf(btf, {.bytes = 10000}).btf;
  ASSERT_EQ(model.sides.size(), 2u);
  EXPECT_GT(errors_of(model, btf).psnr, 35);
  const SrbfEvaluator evaluator(shared(model));
  for (const bool below : {false, true}) EXPECT_TRUE(evaluator.side(below, below).has_value());
}

TEST(SrbfFit, KeepsSidesThatLightGoesThroughTo) {
  const test::MemoryBtf btf = test::striped_btf({4, 4}, true);
  const SrbfBtf model = fit_srbf(btf, {.bytes = 3000}).btf;
  ASSERT_EQ(model.sides.size(), 4u);
  const SrbfEvaluator evaluator(shared(model));
  std::vector<float> rgb;
  const Vec3 up = unit_direction(btf.layout().lights()[0]), down = -up;
  for (const DirectionPair& pair : {DirectionPair{up, down}, DirectionPair{down, up}}) {
    srbf_image(evaluator, pair, rgb);
    for (const float f : rgb) EXPECT_GT(f, 0.0f);
  }
}

TEST(SrbfFit, OfABlackBtfIsBlack) {
  const test::MemoryBtf btf(test::ringed_layout(), small_grid(), [](auto&&...) { return Rgb(0.0f); });
  const SrbfBtf model = fit_srbf(btf, {.bytes = kSrbfBytes}).btf;
  EXPECT_GE(model.sides.at(0).lobes.size(), 1u);  // the file has no parts without values
  const SrbfEvaluator evaluator(shared(model));
  std::vector<float> rgb;
  srbf_image(evaluator, btf.layout().directions(7), rgb);
  for (const float f : rgb) EXPECT_EQ(f, 0.0f);
}

TEST(SrbfFit, TakesASingleTexel) {
  const test::MemoryBtf btf = test::striped_btf({1, 1});
  EXPECT_GT(errors_of(fit_srbf(btf, {}).btf, btf).psnr, 25);
}

TEST(SrbfFit, IsNotPulledByEntriesThatAreNotFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const test::MemoryBtf btf(test::ringed_layout(), small_grid(),
                            [&](const DirectionPair& pair, uint32_t x, uint32_t y) {
                              return x == 3 && y == 4 && pair.wl.x > 0 ? Rgb(nan) : test::striped(pair, x, y);
                            });
  const test::MemoryBtf whole = test::striped_btf(small_grid());
  const SrbfFit found = fit_srbf(btf, {.bytes = kSrbfBytes});
  EXPECT_GT(found.not_finite, 0u);
  EXPECT_GT(errors_of(found.btf, btf).psnr, errors_of(fit_srbf(whole, {.bytes = kSrbfBytes}).btf, whole).psnr - 1);
}

/// Every level under every light has the mean of the measurement, in f itself.
TEST(SrbfFit, CoarseLevelsKeepTheMean) {
  const test::MemoryBtf btf = test::striped_btf(small_grid());
  SrbfBtf model = fit_srbf(btf, {.bytes = kSrbfBytes, .companding = Companding::none}).btf;
  std::vector<float> rgb, coarse;
  const SrbfEvaluator evaluator(shared(model));
  SrbfBtf last = model;
  last.grid = {1, 1, model.grid.tile_metres};
  last.sides[0].levels = {model.sides[0].levels.back()};
  const SrbfEvaluator one(shared(last));
  for (const uint64_t pair : {3, 77, 150}) {
    srbf_image(evaluator, btf.layout().directions(pair), rgb);
    srbf_image(one, btf.layout().directions(pair), coarse);
    for (size_t c = 0; c < 3; ++c) {
      double mean = 0;
      for (size_t t = 0; t < btf.grid().texels(); ++t) mean += static_cast<double>(rgb[3 * t + c]);
      mean /= static_cast<double>(btf.grid().texels());
      EXPECT_NEAR(static_cast<double>(coarse[c]), mean, 0.02 * mean + 1e-3) << pair;
    }
  }
}

TEST(SrbfFit, ReportsRisingProgressAndEndsAtACancel) {
  const test::MemoryBtf btf = test::striped_btf(small_grid());
  Progress progress;
  std::atomic<bool> done{false};
  double before = 0, largest_jump = 0;
  std::thread watcher([&] {
    while (!done) {
      const double now = progress.fraction();
      EXPECT_GE(now, before);
      largest_jump = std::max(largest_jump, now - before);
      before = now;
      std::this_thread::yield();
    }
  });
  fit_srbf(btf, {.bytes = kSrbfBytes}, progress);
  done = true;
  watcher.join();
  EXPECT_NEAR(progress.fraction(), 1, 1e-6);

  Progress cancelled;
  std::thread asks([&] {
    while (cancelled.fraction() < 0.1) std::this_thread::yield();
    cancelled.cancel();
  });
  test::expect_refused(Status::cancelled, "Cancelled", [&] { fit_srbf(btf, {.bytes = kSrbfBytes}, cancelled); });
  asks.join();
  EXPECT_LT(cancelled.fraction(), 1);
}

}  // namespace
}  // namespace velour::srbf_fit_test
