#include "render/film/noise_target.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

#include "render/path/direction_sampling.h"
#include "render/path/path_numbers.h"
#include "support/test_scene.h"

namespace velour::noise_target_test {
namespace {

using test::rendered;
using test::small_options;

PixelSum pixel(std::initializer_list<float> samples) {
  PixelSum sum;
  for (float y : samples) sum.add({.radiance = Rgb(y)});
  return sum;
}

TEST(Blocks, CoverThePictureOnceAndNoneIsSmall) {
  for (const auto& [width, height] : {std::pair{640, 480}, {1, 1}, {17, 40}, {100, 23}, {333, 9}}) {
    std::vector<int> covered(static_cast<size_t>(width * height));
    for (const PixelRect& b : blocks_of({0, 0, width, height})) {
      EXPECT_GE(b.width(), std::min(width, 11));
      EXPECT_LE(b.width(), 24);
      for (int y = b.y0; y < b.y1; ++y) {
        for (int x = b.x0; x < b.x1; ++x) ++covered[static_cast<size_t>(y * width + x)];
      }
    }
    EXPECT_EQ(std::ranges::count(covered, 1), width * height);
  }
  EXPECT_EQ(blocks_of({0, 0, 640, 480}).size(), 40u * 30u);
}

TEST(PixelSum, VarianceComesFromTheDifferenceOfTheHalves) {
  // Halves 1, 1 and 3, 3: means 1 and 3, so the mean 2 has variance (1 - 3)^2 / 4.
  EXPECT_NEAR(pixel({1, 3, 1, 3}).variance(), 1, 1e-6);
  EXPECT_NEAR(pixel({1, 3, 1, 3}).mean_luminance(), 2, 1e-6);
  // What differs inside the halves is not seen.
  EXPECT_NEAR(pixel({1, 1, 3, 3}).variance(), 0, 1e-6);
}

TEST(PixelSum, VarianceOfUnevenHalvesIsUnbiased) {
  RandomStream random(8, 8, 8);
  double sum = 0;
  constexpr int kTrials = 40000;
  for (int i = 0; i < kTrials; ++i) sum += pixel({random.next(), random.next(), random.next()}).variance();
  EXPECT_NEAR(sum / kTrials, 1.0 / 12 / 3, 0.03 / 12 / 3);
}

TEST(BlockError, IsRelativeToBlockAndPicture) {
  const std::vector<PixelSum> block(4, pixel({1, 3}));
  const BlockError error = block_error(block);
  ASSERT_TRUE(error.known);
  EXPECT_NEAR(error.relative_to(0), 0.5, 1e-6);
  EXPECT_NEAR(error.relative_to(1000), 0.01, 1e-5);  // dark beside the picture
  EXPECT_FALSE(block_error(std::vector<PixelSum>(4, pixel({1}))).known);
}

/// Otherwise a single pixel that is not finite would end the render at once.
TEST(BlockError, IsInfiniteUnlessBlockAndPictureAreFinite) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double broken : {kInfinity, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ((BlockError{.variance = broken, .luminance = 1, .known = true}).relative_to(1), kInfinity);
    EXPECT_EQ((BlockError{.variance = 1, .luminance = broken, .known = true}).relative_to(1), kInfinity);
    EXPECT_EQ((BlockError{.variance = 1, .luminance = 1, .known = true}).relative_to(broken), kInfinity);
  }
}

/// A film of one block whose pixels' halves differ by `spread` of their mean.
void fill(Film& film, float spread) {
  std::vector<PixelSum> pixels(256, pixel({1 - spread, 1 + spread}));
  film.store({0, 0, 16, 16}, pixels);
}

TEST(NoiseTarget, ABlockIsDoneAfterTwoGoodDecisionsInARow) {
  Film film(16, 16);
  NoiseTarget target(0.1, blocks_of({0, 0, 16, 16}));
  EXPECT_EQ(target.next_decision(), NoiseTarget::kRaysAtLeast);
  for (float spread : {0.05f, 0.2f, 0.05f}) {  // a lucky one first
    fill(film, spread);
    target.decide(film);
    EXPECT_EQ(target.active().size(), 1u) << spread;
  }
  target.decide(film);
  EXPECT_TRUE(target.active().empty());
  EXPECT_NEAR(target.worst(film), 0.05 / std::sqrt(1.01), 1e-4);
}

TEST(NoiseTarget, DecisionsGrowRarer) {
  Film film(16, 16);
  NoiseTarget target(1e-9, blocks_of({0, 0, 16, 16}));
  fill(film, 0.5f);
  std::vector<int> at;
  for (int i = 0; i < 40; ++i) {
    at.push_back(target.next_decision());
    target.decide(film);
  }
  EXPECT_EQ(at[1], 16);
  EXPECT_GT(at.back(), 1000);
  for (int n : at) EXPECT_EQ(n % NoiseTarget::kRaysAtLeast, 0);
}

TEST(Combination, WeightsOfAllDensitiesAddUpToOne) {
  const Technique drawers[] = {Technique::product, Technique::surface, Technique::lights};
  for (Heuristic heuristic : {Heuristic::balance, Heuristic::power}) {
    for (const auto& share : {std::array{0.0f, 0.5f, 0.5f}, {0.5f, 0.4f, 0.1f}, {0.0f, 1.0f, 0.0f}}) {
      for (const auto& pdf :
           {std::array{1.0f, 1.0f, 1.0f}, {0.0f, 3.0f, 0.1f}, {5.0f, 1e25f, 2.0f}, {2.0f, 0.7f, 0.0f}}) {
        const float q[3] = {share[0] * pdf[0], share[1] * pdf[1], share[2] * pdf[2]};
        float sum = 0;
        for (Technique own : drawers) {
          // f / (n d) times the expected number of such directions, n c p: weights of one f add up to 1.
          const float q_own = q[static_cast<int>(own)];
          if (q_own > 0) sum += q_own / effective_density(heuristic, q, own);
        }
        EXPECT_NEAR(sum, 1, 1e-5) << pdf[0] << ' ' << pdf[1] << ' ' << pdf[2];
      }
    }
  }
}

TEST(Combination, SharesAreThoseOfTheStrategy) {
  RenderOptions options;
  options.light_share = 0.3f;
  options.strategy = Strategy::product;
  const Shares product = shares(mixing_of(options), 0.5f);
  EXPECT_FLOAT_EQ(product.lights, 0.15f);
  EXPECT_FLOAT_EQ(product.surface, 0.35f);
  options.strategy = Strategy::light;
  EXPECT_EQ(shares(mixing_of(options)).lights, 1.0f);
  options.strategy = Strategy::ggx;
  EXPECT_EQ(shares(mixing_of(options)).surface, 1.0f);
}

RenderOptions two_halves(Sequence sequence) {
  RenderOptions options;
  options.sequence = sequence;
  options.noise = 0.1;
  return options;
}

TEST(PathNumbers, DealsTheShareOnAverageAndWithoutGaps) {
  for (Sequence sequence : {Sequence::random, Sequence::sobol}) {
    for (float share : {0.0f, 0.3f, 0.5f, 1.0f}) {
      for (int split : {1, 3, 8}) {
        double lights = 0, directions = 0;
        for (uint64_t pixel = 0; pixel < 500; ++pixel) {
          uint32_t next_surface = 0, next_light = 0;
          for (uint32_t ray = 0; ray < 16; ray += 2) {
            PathNumbers numbers(two_halves(sequence), pixel, ray);
            const auto [surface, light] = numbers.deal(numbers.all(split, split), share, Purpose::side);
            EXPECT_EQ(surface.count + light.count, split);
            EXPECT_LE(std::abs(static_cast<float>(light.count) - static_cast<float>(split) * share), 1.0f);
            if (sequence == Sequence::sobol) {
              EXPECT_EQ(surface.first, next_surface);
              EXPECT_EQ(light.first, next_light);
              next_surface += static_cast<uint32_t>(surface.count);
              next_light += static_cast<uint32_t>(light.count);
            }
            lights += light.count;
            directions += split;
          }
        }
        EXPECT_NEAR(lights / directions, static_cast<double>(share), 0.02);
      }
    }
  }
}

TEST(PathNumbers, CameraRaysOfAHalfContinueOneSequence) {
  Vec2 all[8], parts[8];
  PathNumbers(two_halves(Sequence::sobol), 5, 0).points(Purpose::light, 0, all);
  PathNumbers(two_halves(Sequence::sobol), 5, 0).points(Purpose::light, 0, {parts, 4});
  PathNumbers(two_halves(Sequence::sobol), 5, 2).points(Purpose::light, 4, {parts + 4, 4});
  for (int i = 0; i < 8; ++i) EXPECT_EQ(all[i], parts[i]);
  PathNumbers(two_halves(Sequence::sobol), 5, 1).points(Purpose::light, 0, parts);
  EXPECT_NE(all[0], parts[0]);
  // Without a noise target there is one half.
  RenderOptions whole = two_halves(Sequence::sobol);
  whole.noise = 0;
  PathNumbers(whole, 5, 0).points(Purpose::light, 0, all);
  PathNumbers(whole, 5, 1).points(Purpose::light, 4, parts);
  EXPECT_EQ(all[4], parts[0]);
}

/// Half of the picture has a glossy sky's noise, half sees nothing.
Scene edge() {
  Scene scene;
  scene.add_mesh(test::square(100));
  scene.add_material({std::make_shared<test::Lambert>(0.6f), Rgb(0.0f), false});
  scene.add_instance(0, test::shift({100, 0, 0}), {0});
  std::vector<float> pixels(3 * 16 * 8, 1.0f);
  for (size_t i = 0; i < 3 * 16 * 4; i += 9) pixels[i] = 20;
  scene.set_environment(Environment::image({16, 8, 3, pixels}, 1, Mat3(1.0f)));
  scene.set_camera(test::camera_above(1));
  scene.commit(2);
  return scene;
}

RenderOptions noise_options() {
  RenderOptions options = small_options(Strategy::uniform, 4096);
  options.width = 48;
  options.height = 16;
  options.noise = 0.02;
  options.transparent = true;
  return options;
}

TEST(NoiseTarget, SamplesGoWhereTheNoiseIs) {
  const Scene scene = edge();
  RenderReport report;
  const auto counts = rendered(scene, noise_options(), "Sample Count", &report);
  EXPECT_EQ(counts[0], 16 * 8);  // nothing there: the two decisions at 8 and 16 camera rays
  EXPECT_GT(counts[47], counts[0]);
  EXPECT_EQ(report.blocks_unfinished, std::optional<uint64_t>(0));
  EXPECT_LE(report.block_noise, 0.02);
  EXPECT_EQ(report.spp, static_cast<uint64_t>(std::ranges::max(counts)));
  EXPECT_NEAR(report.spp_mean, test::mean_of(counts, 0, 1), 1e-3);
}

TEST(NoiseTarget, ACapLeavesBlocksUnfinishedAndSaysSo) {
  RenderOptions options = noise_options();
  options.noise = 1e-4;
  options.spp = 256;
  RenderReport report;
  const auto counts = rendered(edge(), options, "Sample Count", &report);
  EXPECT_EQ(counts[47], 256);
  EXPECT_GE(report.blocks_unfinished.value(), 1u);
  EXPECT_GT(report.block_noise, 1e-4);
}

TEST(NoiseTarget, ThePictureDependsNeitherOnThreadsNorOnPasses) {
  const Scene scene = edge();
  RenderOptions options = noise_options();
  const auto picture = rendered(scene, options);
  options.threads = 1;
  EXPECT_EQ(rendered(scene, options), picture);
  for (int rays : {3, 64}) {
    options.camera_rays_per_pass = rays;
    EXPECT_EQ(rendered(scene, options), picture) << rays;
  }
}

TEST(RenderOptions, RefusesWhatIsOutOfRange) {
  const Scene scene = edge();
  for (int wrong = 0; wrong < 4; ++wrong) {
    RenderOptions options = noise_options();
    if (wrong == 0) options.light_share = 1.5f;
    if (wrong == 1) options.noise = -1;
    if (wrong == 2) options.heuristic = static_cast<Heuristic>(7);
    if (wrong == 3) options.sequence = static_cast<Sequence>(-1);
    EXPECT_THROW(rendered(scene, options), Error) << wrong;
  }
}

}  // namespace
}  // namespace velour::noise_target_test
