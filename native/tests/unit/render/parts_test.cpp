// Parts of a picture: crops are the whole's bits, ranges of samples add up to it, a stop ends at a whole pass.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "render/preparation.h"
#include "render/render.h"
#include "unit/render/busy_scene.h"

namespace velour::parts_test {
namespace {

constexpr int kWidth = 37, kHeight = 21, kChannels = 4;

/// A scene that some camera rays miss.
Scene uneven_scene() {
  Scene scene = test::busy_scene();
  scene.set_camera(test::camera_above(4));
  scene.commit(2);
  return scene;
}

RenderOptions options_of(Strategy strategy) {
  RenderOptions o = test::small_options(strategy, 37);
  o.width = kWidth;
  o.height = kHeight;
  o.split = 5;
  o.bounces = 2;
  o.transparent = true;
  return o;
}

std::vector<float> part(const Scene& scene, const RenderOptions& options, const char* pass = "Combined") {
  Film film(options.window());
  Progress progress;
  render(scene, options, film, progress);
  std::vector<float> pixels(static_cast<size_t>(film.width() * film.height() * Film::channels(pass)));
  film.read_pass(pass, pixels);
  return pixels;
}

std::vector<float> cut(const std::vector<float>& whole, const PixelRect& rect) {
  std::vector<float> pixels;
  for (int y = rect.y0; y < rect.y1; ++y) {
    const auto row = whole.begin() + kChannels * (y * kWidth + rect.x0);
    pixels.insert(pixels.end(), row, row + kChannels * rect.width());
  }
  return pixels;
}

TEST(Parts, CropsHaveTheBitsOfTheWhole) {
  const Scene scene = uneven_scene();
  for (Strategy strategy : {Strategy::mis, Strategy::product, Strategy::table}) {
    RenderOptions options = options_of(strategy);
    const std::vector<float> whole = part(scene, options);
    for (const PixelRect& rect : {PixelRect{0, 0, 1, 1}, {5, 3, 30, 21}, {36, 0, 37, 21}, {0, 20, 37, 21}}) {
      options.crop = rect;
      EXPECT_EQ(part(scene, options), cut(whole, rect)) << static_cast<int>(strategy) << ", from " << rect.x0;
    }
    options.crop = {5, 3, 30, 21};  // the ball among others
    options.seed = 1;
    EXPECT_NE(part(scene, options), cut(whole, options.crop));
  }
}

/// Largest difference to `whole` of the mean of ranges with these weights.
float largest_difference(const std::vector<float>& whole, const std::vector<std::vector<float>>& ranges,
                         const std::vector<float>& weights) {
  float sum = 0, most = 0;
  for (float w : weights) sum += w;
  for (size_t i = 0; i < whole.size(); ++i) {
    float mean = 0;
    for (size_t r = 0; r < ranges.size(); ++r) mean += weights[r] / sum * ranges[r][i];
    most = std::max(most, std::abs(mean - whole[i]));
  }
  return most;
}

TEST(Parts, RangesOfSamplesAddUpToTheWhole) {
  const Scene scene = uneven_scene();
  for (Sequence sequence : {Sequence::sobol, Sequence::random}) {
    RenderOptions options = options_of(Strategy::mis);
    options.sequence = sequence;
    const std::vector<float> whole = part(scene, options);
    std::vector<std::vector<float>> ranges;
    for (const SampleRange& range : {SampleRange{0, 5}, {5, 25}, {25, 0}}) {
      options.samples = range;
      ranges.push_back(part(scene, options));
    }
    const std::vector<float> camera_rays = {1, 4, 3};  // the last of 2 directions counts as one, as in the whole
    const float rounding = 1e-5f;
    EXPECT_LT(largest_difference(whole, ranges, camera_rays), rounding);
    EXPECT_GT(largest_difference(whole, ranges, {1, 4, 2.4f}), 100 * rounding) << "weighted by directions";
    options.seed = 1;
    ranges.back() = part(scene, options);
    EXPECT_GT(largest_difference(whole, ranges, camera_rays), 1000 * rounding) << "another seed";
  }
}

TEST(Parts, CountTheirOwnSamples) {
  const Scene scene = uneven_scene();
  RenderOptions options = options_of(Strategy::mis);
  options.samples = {30, 37};
  options.crop = {2, 2, 5, 4};
  for (float count : part(scene, options, "Sample Count")) EXPECT_EQ(count, 7);
  Film film(options.window());
  Progress progress;
  const RenderReport report = render(scene, options, film, progress);
  EXPECT_EQ(report.spp, 7u);
  EXPECT_EQ(report.spp_mean, 7);
  EXPECT_DOUBLE_EQ(progress.fraction(), 1);
}

TEST(Parts, AStopEndsAtAWholePass) {
  const Scene scene = uneven_scene();
  RenderOptions options = options_of(Strategy::mis);
  options.spp = 1 << 24;
  std::atomic<bool> stop{false};
  options.stop = &stop;
  Film film(options.window());
  Progress progress;
  std::thread watcher([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    stop = true;
  });
  const RenderReport report = render(scene, options, film, progress);
  watcher.join();
  EXPECT_GT(report.spp, 0u);
  EXPECT_LT(report.spp, 1u << 24);
  EXPECT_EQ(report.spp % 5, 0u);
  std::vector<float> counts(kWidth * kHeight);
  film.read_pass("Sample Count", counts);
  for (float count : counts) EXPECT_EQ(count, static_cast<float>(report.spp));

  stop = true;  // before the first pass
  EXPECT_EQ(render(scene, options, film, progress).spp, 0u);
}

TEST(Parts, AreRefusedWithTheOptionWhereThereIsNoSuchPart) {
  const auto refused = [&](auto&& change, const char* word) {
    RenderOptions options = options_of(Strategy::mis);
    EXPECT_NO_THROW(checked(options));
    change(options);
    try {
      checked(options);
      ADD_FAILURE() << word;
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), Status::invalid_argument);
      EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
    }
  };
  for (const SampleRange& range : {SampleRange{5, 5}, {10, 5}, {-5, 5}, {0, 40}}) {
    refused([&](RenderOptions& o) { o.samples = range; }, "0:37");
  }
  refused([](RenderOptions& o) { o.samples = {0, 4}; }, "multiples of 5");
  refused([](RenderOptions& o) { o.samples = {3, 10}; }, "multiples of 5");
  for (const PixelRect& crop : {PixelRect{0, 0, 0, 5}, {4, 4, 3, 5}, {-1, 0, 5, 5}, {0, 0, 38, 5}, {0, 0, 5, 22}}) {
    refused([&](RenderOptions& o) { o.crop = crop; }, "crop");
  }
  const auto noisy_part = [](RenderOptions& o) {
    o.noise = 0.1;
    o.samples = {0, 5};
  };
  refused(noisy_part, "noise");
}

}  // namespace
}  // namespace velour::parts_test
