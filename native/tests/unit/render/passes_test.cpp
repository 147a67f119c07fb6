// Passes beyond those that every film has: what they say of surfaces, and the error that they state.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <memory>

#include "base/error.h"
#include "material/principled/principled_material.h"
#include "render/film/cryptomatte.h"
#include "support/textured_scenes.h"
#include "unit/render/busy_scene.h"

namespace velour::passes_test {
namespace {

constexpr size_t kSide = 8;
constexpr const char* kNames[] = {"Position",       "UV",
                                  "IndexOB",        "IndexMA",
                                  "Mist",           "Albedo",
                                  "Error",          "CryptoObject00",
                                  "CryptoObject01", "CryptoMaterial00",
                                  "CryptoAsset02",  "Denoising Albedo",
                                  "Halves",         "Vector"};

/// Everything, with labels for two instances and two materials.
PassOptions all_passes() {
  PassOptions passes;
  passes.asked = pass::kAll;
  passes.mist = {.start = 1, .depth = 8, .exponent = 2};
  passes.instances = {{3, cryptomatte_id("Net"), cryptomatte_id("Stage"), 0},
                      {5, cryptomatte_id("Floor"), cryptomatte_id("Stage"), -1}};
  passes.materials = {{7, cryptomatte_id("Wire")}, {9, cryptomatte_id("Stone")}};
  return passes;
}

std::unique_ptr<Film> rendered(const Scene& scene, const RenderOptions& options, PassOptions passes = all_passes()) {
  auto film = std::make_unique<Film>(options.window(), std::move(passes));
  Progress progress;
  render(scene, options, *film, progress);
  return film;
}

std::vector<float> read(const Film& film, const char* pass) {
  std::vector<float> pixels(static_cast<size_t>(film.width() * film.height() * Film::channels(pass)));
  film.read_pass(pass, pixels);
  return pixels;
}

RenderOptions options_of(int spp) {
  RenderOptions options = test::small_options(Strategy::cosine, spp);
  options.split = 1;
  options.transparent = true;
  return options;
}

SurfaceMaterial matte(float albedo, float alpha = 1) {
  return {make_principled_material({.base_color = Rgb(albedo), .specular = 0}, {}, alpha), Rgb(0.0f), false};
}

/// A square, placed so, over a larger one at z = 0. Pixels are 0.2 wide at z = 1.
Scene two_squares(SurfaceMaterial upper, const Affine& place = test::shift({0, 0, 1}), float floor = 40) {
  Scene scene;
  scene.add_material(std::move(upper));
  scene.add_material(matte(0.3f));
  scene.add_instance(scene.add_mesh(test::textured_square(4, Mat2(0.25f, 0, 0, 0.5f))), place, {0});
  scene.add_instance(scene.add_mesh(test::square(floor)), {}, {1});
  scene.set_environment(Environment::constant(Rgb(1)));
  scene.set_camera(test::camera_above(1));
  scene.commit(1);
  return scene;
}

TEST(Passes, SayWhatTheFirstSurfaceIs) {
  const Scene scene = two_squares(matte(0.6f));
  const auto film = rendered(scene, options_of(64));
  const auto position = read(*film, "Position"), uv = read(*film, "UV"), mist = read(*film, "Mist");
  const auto object = read(*film, "IndexOB"), material = read(*film, "IndexMA"), albedo = read(*film, "Albedo");
  for (size_t i = 0; i < kSide * kSide; ++i) {
    EXPECT_EQ(object[i], 3);
    EXPECT_EQ(material[i], 7);
    const double left = -0.8 + 0.2 * static_cast<double>(i % kSide), low = -0.8 + 0.2 * static_cast<double>(i / kSide);
    EXPECT_NEAR(position[3 * i], left + 0.1, 0.1001);
    EXPECT_NEAR(position[3 * i + 1], low + 0.1, 0.1001);
    EXPECT_NEAR(position[3 * i + 2], 1, 1e-5);
    EXPECT_NEAR(uv[3 * i], 0.5 + 0.25 * (left + 0.1), 1e-3);
    EXPECT_NEAR(uv[3 * i + 1], 0.5 + 0.5 * (low + 0.1), 2e-3);
    EXPECT_EQ(uv[3 * i + 2], 1);
    const double distance = std::hypot(left + 0.1, low + 0.1, 4.0);
    EXPECT_NEAR(mist[i], std::pow((distance - 1) / 8, 2), 1e-3);
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(albedo[3 * i + c], 0.6, 1e-5);
  }
}

TEST(Passes, NothingIsAllMistAndNothingElse) {
  const Scene scene = two_squares(matte(0.6f), test::shift({0, 0, -50}, {1e-3f, 1e-3f, 1}), 0.001f);
  const auto film = rendered(scene, options_of(4));
  for (const char* name : kNames) {
    for (float value : read(*film, name)) EXPECT_EQ(value, name == std::string("Mist") ? 1.0f : 0.0f) << name;
  }
}

/// The pass of a square of albedo 0.6 and `alpha` that emits 2, with nothing behind it but an environment of 1.
std::vector<float> denoising_albedo(float alpha, bool transparent) {
  SurfaceMaterial emissive = matte(0.6f, alpha);
  emissive.emission = Rgb(2.0f);
  const Scene scene = two_squares(std::move(emissive), test::shift({0, 0, 1}, {0.1f, 10, 1}), 0.001f);
  RenderOptions options = options_of(64);
  options.transparent = transparent;
  return read(*rendered(scene, options), "Denoising Albedo");
}

TEST(Passes, DenoisingAlbedoCountsWhatShines) {
  const size_t middle = kSide * kSide / 2 + kSide / 2, left = kSide * kSide / 2;
  for (const bool transparent : {false, true}) {
    const auto pixels = denoising_albedo(1, transparent);
    EXPECT_NEAR(pixels[3 * middle], 2.6, 1e-5);
    EXPECT_EQ(pixels[3 * left], transparent ? 0.0f : 1.0f);
  }
  EXPECT_NEAR(denoising_albedo(0.25f, false)[3 * middle], 0.25 * 2.6 + 0.75, 0.15);
}

TEST(Passes, MistIsLinearOrRooted) {
  EXPECT_EQ((Mist{.start = 2, .depth = 4, .exponent = 1}).at(3), 0.25f);
  EXPECT_EQ((Mist{.start = 2, .depth = 4, .exponent = 0.5f}).at(3), 0.5f);
  EXPECT_EQ((Mist{.start = 2, .depth = 4, .exponent = 1}).at(1), 0.0f);
  EXPECT_EQ((Mist{.start = 2, .depth = 4, .exponent = 1}).at(100), 1.0f);
  EXPECT_EQ((Mist{.start = 2, .depth = 0, .exponent = 1}).at(100), 0.0f);
}

TEST(Passes, AskingForThemLeavesThePictureAsItIs) {
  const Scene scene = test::busy_scene();
  for (Sequence sequence : {Sequence::sobol, Sequence::random}) {
    RenderOptions options = options_of(24);
    options.strategy = Strategy::mis;
    options.bounces = 1;
    options.sequence = sequence;
    EXPECT_EQ(read(*rendered(scene, options), "Combined"), test::rendered(scene, options));
  }
}

TEST(Passes, HaveTheSameBitsWithAnyThreadsAndInCrops) {
  const Scene scene = two_squares(matte(0.6f, 0.4f), test::shift({0.3f, 0, 1}, {0.1f, 0.2f, 1}));
  RenderOptions options = options_of(50);
  options.camera_rays_per_pass = 7;
  const auto whole = rendered(scene, options);
  options.threads = 1;
  options.camera_rays_per_pass = 50;
  const auto alone = rendered(scene, options);
  options.crop = {3, 2, 6, 7};
  const auto crop = rendered(scene, options);
  for (const char* name : kNames) {
    const auto pixels = read(*whole, name), part = read(*crop, name);
    EXPECT_EQ(pixels, read(*alone, name)) << name;
    const auto channels = static_cast<size_t>(Film::channels(name));
    for (size_t y = 0; y < 5; ++y) {
      for (size_t i = 0; i < 3 * channels; ++i) {
        EXPECT_EQ(part[3 * channels * y + i], pixels[(kSide * (y + 2) + 3) * channels + i]) << name;
      }
    }
  }
}

TEST(Passes, ErrorIsTheSpreadOfRenders) {
  const Scene scene = test::busy_scene();
  RenderOptions options = options_of(16);
  options.strategy = Strategy::mis;
  options.sequence = Sequence::random;  // camera rays are independent, as the pass takes them to be
  PassOptions passes;
  passes.asked = pass::kError;
  constexpr int kRenders = 400;
  std::vector<double> sum(4 * kSide * kSide), squares(sum.size());
  double stated = 0, spread = 0;
  for (options.seed = 0; options.seed < kRenders; ++options.seed) {
    const auto film = rendered(scene, options, passes);
    const auto picture = read(*film, "Combined");
    for (float e : read(*film, "Error")) stated += static_cast<double>(e) * static_cast<double>(e) / kRenders;
    for (size_t i = 0; i < picture.size(); ++i) {
      const double x = picture[i];
      if (i % 4 == 3) continue;
      sum[i] += x;
      squares[i] += x * x;
    }
  }
  for (size_t i = 0; i < sum.size(); ++i) spread += (squares[i] - sum[i] * sum[i] / kRenders) / (kRenders - 1);
  EXPECT_GT(spread, 0);
  EXPECT_NEAR(stated / spread, 1, 0.05);
}

TEST(Passes, AreRefusedWhereTheyWereNotAskedFor) {
  PassOptions passes;
  passes.asked = pass::kMist | pass::kCryptoObject;
  passes.cryptomatte_ranks = 4;
  const Film film({0, 0, 1, 1}, passes);
  std::vector<float> one(1), three(3), four(4);
  EXPECT_NO_THROW(film.read_pass("Mist", one));
  EXPECT_NO_THROW(film.read_pass("CryptoObject01", four));
  EXPECT_THROW(film.read_pass("CryptoObject02", four), Error);
  EXPECT_THROW(film.read_pass("CryptoAsset00", four), Error);
  EXPECT_THROW(film.read_pass("Position", three), Error);
  EXPECT_THROW(film.read_pass("Mist", three), Error);
  EXPECT_THROW(Film::channels("CryptoObject0"), Error);
  passes.cryptomatte_ranks = PassOptions::kMaxRanks + 1;
  EXPECT_THROW(Film({0, 0, 1, 1}, passes), Error);
  passes.cryptomatte_ranks = 6;
  passes.asked = pass::kAll + 1;
  EXPECT_THROW(Film({0, 0, 1, 1}, passes), Error);
}

TEST(Cryptomatte, HashesAreThoseOfMurmurHash3) {
  EXPECT_EQ(murmur_hash(""), 0u);
  EXPECT_EQ(murmur_hash("hello"), 0x248bfa47u);
  EXPECT_EQ(murmur_hash("hello, world"), 0x149bbb7fu);
  EXPECT_EQ(murmur_hash("The quick brown fox jumps over the lazy dog"), 0x2e4ff723u);
}

TEST(Cryptomatte, IdsAreNormalNumbers) {
  int changed = 0;
  for (int i = 0; i < 5000; ++i) {
    const std::string name = "Object." + std::to_string(i);
    const uint32_t bits = std::bit_cast<uint32_t>(cryptomatte_id(name)), hash = murmur_hash(name);
    EXPECT_TRUE(std::isnormal(cryptomatte_id(name))) << name;
    const bool unusual = (hash >> 23 & 255) % 255 == 0;
    EXPECT_EQ(bits ^ hash, unusual ? 1u << 23 : 0u) << name;
    changed += unusual;
  }
  EXPECT_GT(changed, 10);
}

TEST(Cryptomatte, SlotsAreSortedByCoverage) {
  float slots[floats_of_ids(2)] = {};
  for (float id : {4.0f, 2.0f, 3.0f, 2.0f, 0.0f, 2.0f, 5.0f, 3.0f, 6.0f}) add_id(id, 1, slots);
  add_id(5, 0, slots);
  float first[4], second[4];
  write_ids(slots, 0, 0.125f, first);
  write_ids(slots, 2, 0.125f, second);
  EXPECT_EQ(std::vector<float>(first, first + 4), (std::vector<float>{2, 0.375f, 3, 0.25f}));
  EXPECT_EQ(std::vector<float>(second, second + 4), (std::vector<float>{4, 0.125f, 5, 0.125f}));  // 6 found no place
}

/// Coverage of `id` in pixel `i`; 0 where it is not among the first two.
double coverage(const std::vector<float>& pixels, size_t i, const char* name) {
  const float id = cryptomatte_id(name);
  for (size_t k = 0; k < 4; k += 2) {
    if (pixels[4 * i + k] == id) return static_cast<double>(pixels[4 * i + k + 1]);
  }
  return 0;
}

TEST(Cryptomatte, AHairIsThereByWhatItCovers) {
  constexpr double kWidth = 0.004;  // 2 % of a pixel
  const Scene scene = two_squares(matte(0.5f), test::shift({0.1f, 0, 1}, {kWidth / 8, 1, 1}));
  const auto film = rendered(scene, options_of(4096));
  const auto objects = read(*film, "CryptoObject00"), assets = read(*film, "CryptoAsset00");
  for (size_t i = 0; i < kSide * kSide; ++i) {
    const double expected = i % kSide == 4 ? kWidth / 0.2 : 0.0;
    EXPECT_NEAR(coverage(objects, i, "Net"), expected, 0.002) << i;
    EXPECT_NEAR(coverage(objects, i, "Floor"), 1 - expected, 0.002) << i;
    EXPECT_EQ(coverage(assets, i, "Stage"), 1) << i;
  }
}

TEST(Cryptomatte, WhatIsThereInPartCoversThatPart) {
  const Scene scene = two_squares(matte(0.5f, 0.3f));
  const auto film = rendered(scene, options_of(4096));
  const auto materials = read(*film, "CryptoMaterial00");
  double wire = 0, stone = 0;
  for (size_t i = 0; i < kSide * kSide; ++i) {
    wire += coverage(materials, i, "Wire") / (kSide * kSide);
    stone += coverage(materials, i, "Stone") / (kSide * kSide);
    EXPECT_GE(materials[4 * i + 1], materials[4 * i + 3]);
  }
  EXPECT_NEAR(wire, 0.3, 0.005);  // its standard error is 0.0009
  EXPECT_NEAR(wire + stone, 1, 1e-6);
}

}  // namespace
}  // namespace velour::passes_test
