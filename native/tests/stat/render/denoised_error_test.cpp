// The error that is stated of a denoised picture, beside the true one.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "base/error.h"
#include "denoise/denoiser.h"
#include "image/picture.h"
#include "render/film/noise_target.h"
#include "support/level.h"
#include "support/proof_scenes.h"
#include "support/test_scene.h"

namespace velour::denoised_error_test {
namespace {

constexpr int kWidth = 64, kHeight = 48;

struct Case {
  test::ProofScene scene;
  int bounces;
  Strategy strategy;
};

// The last ones with so few samples of a bad strategy that hardly anything is left of the picture.
constexpr Case kCases[] = {{test::ProofScene::sphere_under_sun, 0, Strategy::mis},
                           {test::ProofScene::sphere_under_wide_sun, 1, Strategy::mis},
                           {test::ProofScene::metal_under_lamps, 0, Strategy::mis},
                           {test::ProofScene::furnace, 2, Strategy::mis},
                           {test::ProofScene::corner, 0, Strategy::mis},
                           {test::ProofScene::two_bounces, 2, Strategy::mis},
                           {test::ProofScene::corner, 2, Strategy::light},
                           {test::ProofScene::sphere_under_wide_sun, 0, Strategy::cosine},
                           {test::ProofScene::two_bounces, 1, Strategy::srbf},
                           {test::ProofScene::metal_under_lamps, 1, Strategy::uniform}};

RenderOptions options_of(const Case& of, int spp, uint64_t seed) {
  RenderOptions options;
  options.width = kWidth;
  options.height = kHeight;
  options.spp = spp;
  options.split = 1;
  options.bounces = of.bounces;
  options.strategy = of.strategy;
  options.seed = seed;
  options.denoise = true;
  return options;
}

/// Colors, 4 floats a pixel.
std::vector<float> pixels(const Film& film, const char* pass) {
  std::vector<float> out(size_t{4} * kWidth * kHeight);
  film.read_pass(pass, out);
  return out;
}

void render_into(Film& film, const Scene& scene, const RenderOptions& options) {
  Progress progress;
  render(scene, options, film, progress);
}

bool find_denoiser() {
  if (const char* file = std::getenv("VELOUR_OIDN")) set_open_image_denoise_file(file);
  try {
    open_image_denoise();
  } catch (const Error&) {
    return false;
  }
  return true;
}

/// How many of `renders` pictures are within the stated bound.
int covered(const Case& of, int renders, int reference_samples) {
  const Scene scene = test::proof_scene(of.scene);
  Film reference_film(PixelRect{0, 0, kWidth, kHeight});
  // By the strategy that knows the scene best, 128 times the samples or more: its own error is 1 % of what it judges.
  RenderOptions best = options_of(of, reference_samples, 1000);
  best.strategy = Strategy::mis;
  best.denoise = false;
  best.split = 8;  // as good for the light, and a third of the time
  render_into(reference_film, scene, best);
  const auto reference = pixels(reference_film, "Combined");
  int within = 0;
  for (int i = 0; i < renders; ++i) {
    PassOptions passes;
    passes.asked = pass::kHalves;
    Film film({0, 0, kWidth, kHeight}, passes);
    const int spp = 4 << (i % 3);
    render_into(film, scene, options_of(of, spp, static_cast<uint64_t>(i)));
    denoise(film, 1, Progress{});
    const auto picture = pixels(film, "Denoised");
    const double real = compare_pictures(picture.data(), reference.data(), reference.size() / 4, 4).relmse;
    within += real <= film.denoised_error()->bound() ? 1 : 0;
  }
  return within;
}

TEST(DenoisedError, LiesBelowItsBoundInTwoScenes) {
  if (!find_denoiser()) GTEST_SKIP() << "Open Image Denoise is missing: scripts/setup --denoise";
  for (const size_t i : {3, 4}) EXPECT_GE(covered(kCases[i], 6, 2048), 5) << i;
}

TEST(DenoisedError, LiesBelowItsBoundInTenScenes) {
  VELOUR_LONG_TEST();
  if (!find_denoiser()) GTEST_SKIP() << "Open Image Denoise is missing: scripts/setup --denoise";
  int within = 0;
  for (const Case& of : kCases) {
    const int of_scene = covered(of, 20, 8192);
    RecordProperty("scene_" + std::to_string(&of - kCases), of_scene);
    EXPECT_GE(of_scene, 17) << &of - kCases;
    within += of_scene;
  }
  EXPECT_GE(within, 190);  // of 200
}

}  // namespace
}  // namespace velour::denoised_error_test
