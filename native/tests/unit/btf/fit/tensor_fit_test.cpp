#include "btf/fit/tensor/tensor_fit.h"

#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <thread>

#include "btf/fit/btf_compare.h"
#include "btf/model/tensor_evaluator.h"
#include "support/example_tensor.h"
#include "support/fitted_btfs.h"
#include "support/striped_btf.h"

namespace velour::tensor_fit_test {
namespace {

constexpr uint64_t kTensorBytes = 5000;
constexpr ShapeRange kTucker{1, 1, 1, 1}, kCta{1, 64, 1, 1}, kKcta{1, 64, 1, 4}, kThree{3, 3, 2, 2};

struct TensorFit {
  TensorBtf btf;
  std::vector<ShapeTrial> shapes;
  uint64_t not_finite;
};

/// Setting up is the first half of the progress.
TensorFit fit_tensor(const BtfMeasurement& btf, const BtfFitOptions& options, const ShapeRange& range,
                     Progress& progress, FitCheckpoint& checkpoint) {
  std::optional<TensorFitter> fitter;
  {
    const Progress::Span setup(progress, 0, 0.5);
    fitter.emplace(btf, options, range, checkpoint, progress);
  }
  const Progress::Span fitting(progress, 0.5, 1);
  return {std::get<TensorBtf>(fitter->fit(fitter->largest())), fitter->shapes(), fitter->not_finite()};
}

TensorFit fit_tensor(const BtfMeasurement& btf, const BtfFitOptions& options, const ShapeRange& range = kKcta) {
  Progress progress;
  FitCheckpoint none;
  return fit_tensor(btf, options, range, progress, none);
}

BtfErrors errors_of(const TensorBtf& model, const BtfMeasurement& btf) {
  const TensorImages images(model);
  const auto decode = [&](const DirectionPair& pair, std::vector<float>& rgb) { images.image(pair, rgb); };
  Progress progress;
  return compare_btf(btf, decode, {percentile_99(btf, progress)}, 2, progress);
}

/// What a model shows.
test::MemoryBtf images_of(const TensorBtf& model) {
  const TensorImages images(model);
  return test::shown_by(model.layout, model.grid,
                        [&](const DirectionPair& pair, std::vector<float>& rgb) { images.image(pair, rgb); });
}

TexelGrid tensor_grid() { return {12, 8, Vec2(0.003f, 0.002f)}; }

/// A model of 12 x 8 texels, over a plane or over hills, whose texels are made of two of three clusters.
TensorBtf true_tensor(float high) {
  const test::TensorShape shape{3, 2, {3, 3, 3, 2}, high > 0};
  TensorBtf btf{test::ringed_layout(), tensor_grid(), Companding::root, Mat3(1.0f), {}};
  btf.sides.push_back(test::random_side(btf.layout, btf.grid, false, shape));
  if (high == 0) return btf;
  std::vector<float> heights;
  for (uint32_t t = 0; t < btf.grid.texels(); ++t) {
    const float x = 2 * kPi * static_cast<float>(t % 12) / 12, y = 2 * kPi * static_cast<float>(t / 12) / 8;
    heights.push_back(high * std::sin(x) * std::cos(y));
  }
  btf.sides[0].levels[0].relief = test::halves_of(heights);
  return btf;
}

test::MemoryBtfWithRelief with_relief(const TensorBtf& model) {
  return test::over_relief(images_of(model), heights_of(model.sides[0].levels[0]));
}

void expect_same(const TensorBtf& a, const TensorBtf& b) {
  ASSERT_EQ(a.sides.size(), b.sides.size());
  for (size_t s = 0; s < a.sides.size(); ++s) {
    ASSERT_EQ(a.sides[s].clusters.size(), b.sides[s].clusters.size());
    for (size_t c = 0; c < a.sides[s].clusters.size(); ++c) {
      const TensorBtfCluster &one = a.sides[s].clusters[c], &two = b.sides[s].clusters[c];
      EXPECT_EQ(one.view, two.view);
      EXPECT_EQ(one.light, two.light);
      EXPECT_EQ(one.core, two.core);
    }
    ASSERT_EQ(a.sides[s].levels.size(), b.sides[s].levels.size());
    for (size_t l = 0; l < a.sides[s].levels.size(); ++l) {
      EXPECT_EQ(a.sides[s].levels[l].member, b.sides[s].levels[l].member);
      EXPECT_EQ(a.sides[s].levels[l].value, b.sides[s].levels[l].value);
    }
  }
}

/// The images of a model of three clusters, of which a texel has two, made a BTF and fitted again.
TEST(TensorFit, RecoversABtfThatIsAModel) {
  const test::MemoryBtf btf = images_of(true_tensor(0));
  EXPECT_GT(errors_of(fit_tensor(btf, {.bytes = 5000}, kThree).btf, btf).psnr, 40);
  // The control: fewer bytes than it is made of are not enough.
  EXPECT_LT(errors_of(fit_tensor(btf, {.bytes = 800}, kThree).btf, btf).psnr, 36);
}

TEST(TensorFit, RecoversABtfThatIsAModelOverARelief) {
  const test::MemoryBtfWithRelief btf = with_relief(true_tensor(0.09f));
  const double over_relief = errors_of(fit_tensor(btf, {.bytes = 4000}, kThree).btf, btf).psnr;
  const TensorBtf flat = fit_tensor(btf, {.bytes = 4000, .relief = false}, kThree).btf;
  EXPECT_GT(over_relief, 35);
  EXPECT_GT(over_relief, errors_of(flat, btf).psnr + 3);
  EXPECT_TRUE(flat.sides[0].levels[0].relief.empty());
}

TEST(TensorFit, MoreFreedomIsNoWorseAtEqualBytes) {
  const test::MemoryBtf btf = images_of(true_tensor(0));
  const BtfFitOptions options{.bytes = 1600};
  const double tucker = errors_of(fit_tensor(btf, options, kTucker).btf, btf).relative_l2,
               cta = errors_of(fit_tensor(btf, options, kCta).btf, btf).relative_l2,
               kcta = errors_of(fit_tensor(btf, options, kKcta).btf, btf).relative_l2;
  EXPECT_LE(cta, 1.02 * tucker);
  EXPECT_LE(kcta, 1.02 * cta);
}

TEST(TensorFit, MoreClustersHaveToBeBetterByAHundredth) {
  EXPECT_FALSE(is_better_shape(4, 0.2879, 1, 0.2881));
  EXPECT_TRUE(is_better_shape(8, 0.2826, 1, 0.2881));
  EXPECT_TRUE(is_better_shape(1, 0.2879, 4, 0.2881));
  EXPECT_FALSE(is_better_shape(1, 0.2882, 4, 0.2881));
}

TEST(TensorFit, ShapesAreRivalsWhereTheyAreCloseAndTexelsHaveFewCoefficients) {
  const auto judged = [](uint32_t clusters, uint32_t texel_rank, double error) {
    return JudgedShape{{clusters, 1, 1, 0.6}, {clusters, 1, {texel_rank, 4, 4, 1}}, error};
  };
  EXPECT_TRUE(is_rival(judged(1, 5, 0.430), judged(4, 5, 0.400)));
  EXPECT_FALSE(is_rival(judged(1, 5, 0.433), judged(4, 5, 0.400)));
  EXPECT_FALSE(is_rival(judged(1, 50, 0.430), judged(4, 50, 0.400)));
  EXPECT_TRUE(is_rival(judged(4, 5, 0.401), judged(1, 5, 0.400)));
  EXPECT_FALSE(is_rival(judged(1, 5, 0.400), judged(1, 5, 0.400)));
}

/// The control: the search alone would have taken more clusters than one.
TEST(TensorFit, ModelsDecideBetweenShapesThatAreClose) {
  std::vector<float> steps;
  for (uint32_t t = 0; t < tensor_grid().texels(); ++t)
    steps.push_back(t % 12 / 3 % 2 == t / 12 / 3 % 2 ? 0.15f : 0.0f);
  const test::MemoryBtfWithRelief btf = test::over_relief(images_of(true_tensor(0)), steps);
  const TensorFit cta = fit_tensor(btf, {.bytes = 900}, kCta);
  double one = 2, more = 2;
  for (const ShapeTrial& t : cta.shapes)
    (t.clusters == 1 ? one : more) = std::min(t.expected, t.clusters == 1 ? one : more);
  EXPECT_TRUE(is_better_shape(4, more, 1, one));
  EXPECT_EQ(cta.btf.sides[0].clusters.size(), 1u);
  EXPECT_LE(errors_of(cta.btf, btf).relative_l2,
            errors_of(fit_tensor(btf, {.bytes = 900}, kTucker).btf, btf).relative_l2);
}

TEST(TensorFit, OfOneClusterIsTucker) {
  const test::MemoryBtf btf = test::striped_btf(tensor_grid());
  expect_same(fit_tensor(btf, {.bytes = kTensorBytes, .clusters = 1, .members = 1}, kTucker).btf,
              fit_tensor(btf, {.bytes = kTensorBytes}, {1, 1, 1, 1}).btf);
}

TEST(TensorFit, KeepsToItsBytesAndItsShape) {
  const test::MemoryBtf btf = test::striped_btf(tensor_grid());
  for (const uint64_t bytes : {2000, 6000}) {
    const TensorFit found = fit_tensor(btf, {.bytes = bytes});
    EXPECT_LE(found.btf.parameter_bytes(), bytes);
    EXPECT_GT(found.btf.parameter_bytes(), bytes / 2);
    EXPECT_GT(found.shapes.size(), 3u);
    for (const ShapeTrial& shape : found.shapes) EXPECT_LE(shape.parameter_bytes, bytes);
  }
  const TensorBtf fixed = fit_tensor(btf, {.bytes = kTensorBytes}, {4, 4, 2, 2}).btf;
  EXPECT_EQ(fixed.sides[0].clusters.size(), 4u);
  EXPECT_EQ(fixed.sides[0].members, 2u);
}

TEST(TensorFit, IsTheSameForAnyNumberOfThreads) {
  const test::MemoryBtfWithRelief btf = with_relief(true_tensor(0.09f));
  expect_same(fit_tensor(btf, {.bytes = kTensorBytes, .threads = 1}, kThree).btf,
              fit_tensor(btf, {.bytes = kTensorBytes, .threads = 2}, kThree).btf);
}

/// The limit leaves no room for matrices that can be computed again.
TEST(TensorFit, IsTheSameWithJustEnoughMemory) {
  const test::MemoryBtfWithRelief btf = with_relief(true_tensor(0.09f));
  const uint64_t enough = tensor_fit_size(btf, {.bytes = kTensorBytes}).memory;
  expect_same(fit_tensor(btf, {.bytes = kTensorBytes, .memory = enough}, kThree).btf,
              fit_tensor(btf, {.bytes = kTensorBytes}, kThree).btf);
}

TEST(TensorFit, RefusesTooFewBytesWithASentence) {
  test::expect_refused(Status::invalid_argument, "the maximum size is 100 bytes",
                       [] { fit_tensor(test::striped_btf(tensor_grid()), {.bytes = 100}); });
}

TEST(TensorFit, IsAsBrightAsWhatItLeavesOut) {
  uint64_t entry = 0;
  const auto noise = [&entry](auto&&...) { return Rgb(0.5f, 0.3f, 0.2f) * RandomStream(7, entry++, 0).next(); };
  const test::MemoryBtf btf(test::ringed_layout(), tensor_grid(), noise);
  const BtfErrors errors = errors_of(fit_tensor(btf, {.bytes = 2000}, kThree).btf, btf);
  EXPECT_NEAR(errors.brightness, 1, 0.01);
  EXPECT_GT(errors.ser, 0.1) << "the control: most of the spread of the roots is lost";
}

TEST(TensorFit, OfABlackBtfIsBlack) {
  const test::MemoryBtf btf(test::ringed_layout(), tensor_grid(), [](auto&&...) { return Rgb(0.0f); });
  const TensorBtf model = fit_tensor(btf, {.bytes = kTensorBytes}, kThree).btf;
  std::vector<float> rgb;
  TensorImages(model).image(btf.layout().directions(7), rgb);
  for (const float f : rgb) EXPECT_EQ(f, 0.0f);
}

TEST(TensorFit, OfTexelsThatAreAllTheSameIsExact) {
  const test::MemoryBtf btf(test::ringed_layout(), tensor_grid(),
                            [](const DirectionPair& pair, uint32_t, uint32_t) { return test::striped(pair, 1, 1); });
  EXPECT_GT(errors_of(fit_tensor(btf, {.bytes = kTensorBytes}, kThree).btf, btf).psnr, 45);
  const test::MemoryBtf constant(test::ringed_layout(), tensor_grid(), [](auto&&...) { return Rgb(0.2f, 0.3f, 0.1f); });
  EXPECT_GT(errors_of(fit_tensor(constant, {.bytes = kTensorBytes}, kThree).btf, constant).psnr, 60);
}

TEST(TensorFit, TakesFewerTexelsThanClusters) {
  const test::MemoryBtf one = test::striped_btf({1, 1}), six = test::striped_btf({3, 2});
  EXPECT_GT(errors_of(fit_tensor(one, {}).btf, one).psnr, 30);
  const TensorBtf model = fit_tensor(six, {.bytes = 40000}, {16, 16, 2, 2}).btf;
  EXPECT_EQ(model.sides[0].clusters.size(), 16u);
  EXPECT_GT(errors_of(model, six).psnr, 30);
}

/// One texel of another kind than all others does not spoil them.
TEST(TensorFit, OfAnOutlierKeepsTheOthers) {
  const test::MemoryBtf whole = test::striped_btf(tensor_grid());
  const test::MemoryBtf btf(test::ringed_layout(), tensor_grid(),
                            [](const DirectionPair& pair, uint32_t x, uint32_t y) {
                              return x == 5 && y == 2 ? Rgb(pair.wl.x > 0 ? 3.0f : 0.0f) : test::striped(pair, x, y);
                            });
  const TensorBtf model = fit_tensor(btf, {.bytes = kTensorBytes}, kThree).btf;
  EXPECT_GT(errors_of(model, btf).psnr,
            errors_of(fit_tensor(whole, {.bytes = kTensorBytes}, kThree).btf, whole).psnr - 4);
}

TEST(TensorFit, IsNotPulledByEntriesThatAreNotFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const test::MemoryBtf btf(test::ringed_layout(), tensor_grid(),
                            [&](const DirectionPair& pair, uint32_t x, uint32_t y) {
                              return x == 3 && y == 4 && pair.wl.x > 0 ? Rgb(nan) : test::striped(pair, x, y);
                            });
  const test::MemoryBtf whole = test::striped_btf(tensor_grid());
  const TensorFit found = fit_tensor(btf, {.bytes = kTensorBytes}, kThree);
  EXPECT_GT(found.not_finite, 0u);
  EXPECT_GT(errors_of(found.btf, btf).psnr,
            errors_of(fit_tensor(whole, {.bytes = kTensorBytes}, kThree).btf, whole).psnr - 1);
}

TEST(TensorFit, OfTwoSidesFitsBothAndThoseThatLightGoesThroughTo) {
  const test::MemoryBtf btf = test::striped_btf({4, 4}, true);
  const TensorBtf model = fit_tensor(btf, {.bytes = 20000}, kThree).btf;
  ASSERT_EQ(model.sides.size(), 4u);
  EXPECT_LE(model.parameter_bytes(), 20000u);
  EXPECT_GT(errors_of(model, btf).psnr, 30);
}

TEST(TensorFit, NeedsEveryPair) {
  const PairLayout holes(ring_directions(30, 2), ring_directions(50, 2), {{0, 1}, {0}});
  test::expect_refused(Status::unsupported, "3 view-light pairs",
                       [&] { fit_tensor(test::MemoryBtf(holes, tensor_grid(), test::striped), {}); });
}

/// Every level under every light has the mean of the measurement, in f itself.
TEST(TensorFit, CoarseLevelsKeepTheMean) {
  const test::MemoryBtf btf = test::striped_btf(tensor_grid());
  const TensorBtf model = fit_tensor(btf, {.bytes = kTensorBytes, .companding = Companding::none}, kThree).btf;
  TensorBtf last = model;
  last.grid = {1, 1, model.grid.tile_metres};
  last.sides[0].levels = {model.sides[0].levels.back()};
  std::vector<float> rgb, coarse;
  for (const uint64_t pair : {3, 77, 150}) {
    TensorImages(model).image(btf.layout().directions(pair), rgb);
    TensorImages(last).image(btf.layout().directions(pair), coarse);
    for (size_t c = 0; c < 3; ++c) {
      double mean = 0;
      for (size_t t = 0; t < btf.grid().texels(); ++t) mean += static_cast<double>(rgb[3 * t + c]);
      mean /= static_cast<double>(btf.grid().texels());
      EXPECT_NEAR(static_cast<double>(coarse[c]), mean, 0.02 * mean + 1e-3) << pair;
    }
  }
}

TEST(TensorFit, ReportsRisingProgressAndEndsAtACancel) {
  const test::MemoryBtf btf = test::striped_btf(tensor_grid());
  Progress progress;
  FitCheckpoint none;
  fit_tensor(btf, {.bytes = kTensorBytes}, kThree, progress, none);
  EXPECT_NEAR(progress.fraction(), 1, 1e-6);

  Progress cancelled;
  std::thread asks([&] {
    while (cancelled.fraction() < 0.3) std::this_thread::yield();
    cancelled.cancel();
  });
  test::expect_refused(Status::cancelled, "Cancelled",
                       [&] { fit_tensor(btf, {.bytes = kTensorBytes}, kThree, cancelled, none); });
  asks.join();
  EXPECT_LT(cancelled.fraction(), 1);
}

}  // namespace
}  // namespace velour::tensor_fit_test
