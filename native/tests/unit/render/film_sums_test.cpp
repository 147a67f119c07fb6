// Sums that runs hand on: whoever goes on has the bits of one run, and sums of several add up to it.
#include "render/film/film.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "base/error.h"
#include "render/film/cryptomatte.h"
#include "render/render.h"
#include "unit/render/busy_scene.h"

namespace velour::film_sums_test {
namespace {

constexpr int kWidth = 37, kHeight = 21;
constexpr const char* kFirst[] = {"Depth", "Position", "IndexOB", "IndexMA"};  // of the first camera ray
constexpr const char* kMeans[] = {"Combined",       "Normal",           "Sample Count", "UV",
                                  "Mist",           "Albedo",           "Error",        "Denoising Albedo",
                                  "CryptoObject00", "CryptoMaterial00", "Halves"};

Scene uneven_scene() {
  Scene scene = test::busy_scene();
  scene.set_camera(test::camera_above(4));
  scene.commit(2);
  return scene;
}

PassOptions all_passes() {
  PassOptions passes;
  passes.asked = pass::kAll;
  passes.instances = {{3, cryptomatte_id("Ground"), cryptomatte_id("Stage"), -1},
                      {5, cryptomatte_id("Ball"), cryptomatte_id("Stage"), -1}};
  passes.materials = {{7, cryptomatte_id("Chalk")}};
  return passes;
}

RenderOptions options_of(SampleRange samples) {
  RenderOptions o = test::small_options(Strategy::mis, 37);
  o.width = kWidth;
  o.height = kHeight;
  o.split = 3;
  o.bounces = 1;
  o.transparent = true;
  o.samples = samples;
  return o;
}

/// Adds the camera rays of `samples` to what `film` has.
void go_on(const Scene& scene, SampleRange samples, Film& film) {
  RenderOptions options = options_of(samples);
  options.onto_film = true;
  Progress progress;
  render(scene, options, film, progress);
}

struct EmptyFilm : Film {
  EmptyFilm() : Film({0, 0, kWidth, kHeight}, all_passes()) {}
};
struct FilmOf : EmptyFilm {
  FilmOf(const Scene& scene, SampleRange samples) { go_on(scene, samples, *this); }
};

std::vector<float> sums_of(const Film& film) {
  std::vector<float> sums(sums_per_pixel(film) * kWidth * kHeight);
  read_sums(film, sums);
  return sums;
}

std::vector<float> read(const Film& film, const char* pass) {
  std::vector<float> pixels(static_cast<size_t>(kWidth * kHeight * Film::channels(pass)));
  film.read_pass(pass, pixels);
  return pixels;
}

float largest_difference(const std::vector<float>& a, const std::vector<float>& b) {
  float most = 0;
  for (size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

TEST(FilmSums, GoingOnHasTheBitsOfOneRun) {
  const Scene scene = uneven_scene();
  const FilmOf whole(scene, {0, 37}), before(scene, {0, 15});
  EmptyFilm film;
  add_sums(sums_of(before), film);
  EXPECT_EQ(sums_of(film), sums_of(before));
  go_on(scene, {15, 37}, film);
  EXPECT_EQ(sums_of(film), sums_of(whole));
  EXPECT_NE(sums_of(before), sums_of(whole));
}

TEST(FilmSums, OfSeveralRunsAddUpToOne) {
  const Scene scene = uneven_scene();
  const FilmOf whole(scene, {0, 37});
  EmptyFilm film;
  for (const SampleRange& range : {SampleRange{0, 9}, {9, 15}, {15, 37}}) {  // 3, 2 and 8 camera rays
    add_sums(sums_of(FilmOf(scene, range)), film);
  }
  for (const char* pass : kFirst) EXPECT_EQ(read(film, pass), read(whole, pass)) << pass;
  for (const char* pass : kMeans) EXPECT_LT(largest_difference(read(film, pass), read(whole, pass)), 2e-5f) << pass;
  EXPECT_NEAR(film.noise(), whole.noise(), 1e-5 * whole.noise());
}

TEST(FilmSums, TellWhatComesFirst) {
  const Scene scene = uneven_scene();
  FilmOf film(scene, {9, 37});
  add_sums(sums_of(FilmOf(scene, {0, 9})), film);
  EXPECT_NE(read(film, "Depth"), read(FilmOf(scene, {0, 37}), "Depth"));
}

TEST(FilmSums, TheErrorIsThatOfAllRays) {
  const Scene scene = uneven_scene();
  const FilmOf whole(scene, {0, 37}), first(scene, {0, 18}), second(scene, {18, 37});
  const auto all = read(whole, "Error"), a = read(first, "Error"), b = read(second, "Error");
  float apart = 0;  // of what it would be if the means of both were one
  for (size_t i = 0; i < all.size(); ++i) {
    const float squares = a[i] * a[i] * 6 * 5 + b[i] * b[i] * 7 * 6;  // 6 and 7 camera rays
    apart = std::max(apart, std::abs(std::sqrt(squares / (13 * 12)) - all[i]));
  }
  EXPECT_GT(apart, 1e-2f);
}

/// Beyond, floats skip integers: the count that is added would be another one.
TEST(FilmSums, RefuseMoreRaysThanAFloatCounts) {
  Film film(1, 1);
  std::vector<float> sums(sums_per_pixel(film));
  const auto with_rays = [&](uint32_t rays, uint32_t directions) {
    std::vector<PixelSum> pixels(1);
    pixels[0].camera_rays = rays;
    pixels[0].directions = directions;
    film.store({0, 0, 1, 1}, pixels);
    read_sums(film, sums);
  };
  constexpr uint32_t kMost = 1u << 24;
  EXPECT_NO_THROW(with_rays(kMost, kMost)) << "control";
  EXPECT_THROW(with_rays(kMost + 1, kMost + 1), Error);
  EXPECT_THROW(with_rays(1, kMost + 1), Error);
}

TEST(FilmSums, RefuseWhatIsNone) {
  const Scene scene = uneven_scene();
  FilmOf film(scene, {0, 9});
  const std::vector<float> before = sums_of(film);
  const size_t rays = 10;  // place of their number in a pixel
  for (float wrong : {-1.0f, 0.5f, 1e9f, std::numeric_limits<float>::infinity(), std::nanf("")}) {
    std::vector<float> sums = before;
    sums[sums_per_pixel(film) * 5 + rays] = wrong;
    EXPECT_THROW(add_sums(sums, film), Error) << wrong;
    EXPECT_EQ(sums_of(film), before);
  }
  EXPECT_THROW(add_sums(std::vector<float>(before.begin(), before.end() - 1), film), Error);
}

}  // namespace
}  // namespace velour::film_sums_test
