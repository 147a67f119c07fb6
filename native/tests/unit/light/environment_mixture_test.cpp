// The sky's mixture: known skies are found again, suns survive, the cache only ever saves time.
#include "light/environment_mixture.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "light/environment.h"
#include "light/equirectangular.h"
#include "math/srbf/kernel.h"
#include "support/test_data.h"

namespace velour::environment_mixture_test {
namespace {

constexpr int kWidth = 512, kHeight = 256;

/// The image of a radiance, a function of direction.
template <class F>
Environment image_of(const F& radiance, const Mat3& turn = Mat3(1.0f), int width = kWidth, int height = kHeight) {
  std::vector<float> rgb;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float phi = 2 * kPi * (0.5f - (static_cast<float>(x) + 0.5f) / static_cast<float>(width));
      const Rgb c = radiance(direction(kPi * (static_cast<float>(y) + 0.5f) / static_cast<float>(height), phi));
      rgb.insert(rgb.end(), {c.r, c.g, c.b});
    }
  }
  return Environment::image({width, height, 3, rgb}, 1, turn);
}

EnvironmentMixture fitted(const Environment& environment, const std::string& folder = {}) {
  const Progress progress;
  return mixture_of_environment(environment, {}, folder, progress);
}

const Vec3 kFirst = glm::normalize(Vec3(1, 0.5f, 0.7f)), kSecond = glm::normalize(Vec3(-0.6f, 0.7f, -0.2f));

Rgb two_lobes(const Vec3& w) {
  return 3.0f * Rgb(1, 0.5f, 0.2f) * std::exp(40 * (glm::dot(w, kFirst) - 1)) +
         Rgb(0.1f, 0.3f, 1) * std::exp(8 * (glm::dot(w, kSecond) - 1));
}

Rgb energy(const EnvironmentMixture& sky) {
  Rgb total(0);
  for (size_t k = 0; k < sky.size(); ++k) {
    total += static_cast<float>(kernel_integral(Kernel::gaussian, static_cast<double>(sky.bandwidth[k]))) *
             sky.coefficient[k];
  }
  return total;
}

TEST(EnvironmentMixture, FindsAKnownMixture) {
  const EnvironmentMixture sky = fitted(image_of(two_lobes));
  EXPECT_LT(sky.relative_l2, 0.03f);
  double error = 0, norm = 0;
  for (int i = 0; i < 4000; ++i) {
    const float z = 1 - 2 * (static_cast<float>(i) + 0.5f) / 4000;
    const float phi = 2.3999632f * static_cast<float>(i);
    const Vec3 w(std::sqrt(1 - z * z) * std::cos(phi), std::sqrt(1 - z * z) * std::sin(phi), z);
    Rgb value(0);
    for (size_t k = 0; k < sky.size(); ++k) {
      value += sky.coefficient[k] * std::exp(sky.bandwidth[k] * (glm::dot(w, sky.center[k]) - 1));
    }
    error += static_cast<double>(glm::dot(value - two_lobes(w), value - two_lobes(w)));
    norm += static_cast<double>(glm::dot(two_lobes(w), two_lobes(w)));
  }
  EXPECT_LT(std::sqrt(error / norm), 0.06);
}

/// Whoever lights or turns a picture anew finds its fit in the cache.
TEST(EnvironmentMixture, OfAPictureThatIsPlacedAnewIsTheSame) {
  const Mat3 turn(Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1));
  const Environment environment = image_of(two_lobes, Mat3(1.0f), 64, 32);
  const EnvironmentMixture sky = fitted(environment), placed = fitted(environment.placed(2.5f, turn));
  ASSERT_EQ(placed.size(), sky.size());
  for (size_t k = 0; k < sky.size(); ++k) {
    EXPECT_LT(glm::distance(turn * placed.center[k], sky.center[k]), 1e-6f);
    EXPECT_EQ(placed.coefficient[k].g, 2.5f * sky.coefficient[k].g);
  }
}

EnvironmentMixture even() {
  EnvironmentMixture sky;
  sky.center = {{0, 0, 1}};
  sky.bandwidth = {0};
  sky.coefficient = {Rgb(1.0f)};
  return sky;
}

TEST(EnvironmentMisfit, IsChiSquare) {
  const auto cap = [](float z) { return image_of([z](const Vec3& w) { return Rgb(w.z > z ? 1.0f : 0.0f); }); };
  EXPECT_NEAR(misfit_of_environment(Environment::constant(Rgb(2.0f)), even()), 0, 1e-5);
  EXPECT_NEAR(misfit_of_environment(cap(0), even()), 1, 0.01);     // half of the sphere
  EXPECT_NEAR(misfit_of_environment(cap(0.5f), even()), 3, 0.03);  // a quarter
}

TEST(EnvironmentMisfit, TellsEdgesFromSlopes) {
  const Environment soft = image_of(two_lobes);
  EXPECT_LT(misfit_of_environment(soft, fitted(soft)), 0.03);
  const Environment lamps = image_of([](const Vec3& w) {
    const float phi = 8 * std::atan2(w.y, w.x) / kPi;  // sixteen of them around
    const bool lit = std::abs(phi - std::round(phi)) < 0.2f && std::abs(w.z - 0.5f) < 0.06f;
    return Rgb(lit ? 50.0f : 0.05f);
  });
  EXPECT_GT(misfit_of_environment(lamps, fitted(lamps)), 0.2);
  EnvironmentMixture dimmed = fitted(soft);
  for (size_t k = 0; k < dimmed.size(); ++k) {
    if (glm::dot(dimmed.center[k], kSecond) > 0.5f) dimmed.coefficient[k] *= 0.01f;
  }
  EXPECT_GT(misfit_of_environment(soft, dimmed), 1);  // light that the mixture hardly has
}

TEST(EnvironmentMixture, KeepsTheEnergyOfEveryChannelAndIsNeverNegative) {
  const Environment environment = image_of(two_lobes);
  const EnvironmentMixture sky = fitted(environment);
  const Rgb kept = energy(sky), exact(2 * kPi * (3 / 40.0f * Rgb(1, 0.5f, 0.2f) + 1 / 8.0f * Rgb(0.1f, 0.3f, 1)));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(kept[c] / exact[c], 1, 0.002) << c;
  for (size_t k = 0; k < sky.size(); ++k) {
    EXPECT_GE(std::min({sky.coefficient[k].r, sky.coefficient[k].g, sky.coefficient[k].b}), 0);
    EXPECT_GT(sky.bandwidth[k], 0);
  }
}

TEST(EnvironmentMixture, ASmallSunSurvives) {
  // Half a degree across with nine tenths of the energy, over an uneven sky.
  const Vec3 sun = glm::normalize(Vec3(0.4f, -0.8f, 0.5f));
  const float disk = 2 * kPi * (1 - std::cos(radians_from(0.25f)));
  const auto radiance = [&](const Vec3& w) {
    const Rgb sky(0.5f + 0.5f * w.z * w.x);
    const bool inside = glm::distance(w, sun) < 2 * std::sin(radians_from(0.125f));
    return inside ? sky + Rgb(9 * 0.5f * 4 * kPi / disk) : sky;
  };
  const EnvironmentMixture sky = fitted(image_of(radiance, Mat3(1.0f), 2048, 1024));
  // Energy of the lobes within a quarter of a degree of the sun's center, in closed form for a lobe about it: lobes
  // elsewhere add less than the sky's own millionth.
  double near = 0;
  const double d = 2 * std::pow(std::sin(0.5 * radians_from(0.25)), 2);
  for (size_t k = 0; k < sky.size(); ++k) {
    if (glm::distance(sky.center[k], sun) > radians_from(0.1f)) continue;
    const auto l = static_cast<double>(sky.bandwidth[k]);
    near += static_cast<double>(luminance(sky.coefficient[k])) * 2 * kPiD / l * -std::expm1(-l * d);
  }
  const double total = static_cast<double>(luminance(energy(sky)));
  // A Gaussian of the disk's own second moment holds 86 % of its mass within the disk's edge; the lobe as a whole
  // holds the disk's energy.
  EXPECT_GT(near / total, 0.80 * 0.9);
  double whole = 0;
  for (size_t k = 0; k < sky.size(); ++k) {
    if (glm::distance(sky.center[k], sun) < radians_from(0.1f) && sky.bandwidth[k] > 5e4f) {
      whole += static_cast<double>(luminance(sky.coefficient[k])) * 2 * kPiD / static_cast<double>(sky.bandwidth[k]);
    }
  }
  EXPECT_NEAR(whole / total / 0.9, 1, 0.05);
}

TEST(EnvironmentMixture, IsTheSameForAnyNumberOfThreads) {
  const Environment environment = image_of(two_lobes);
  std::vector<EnvironmentMixture> skies;
  for (const int threads : {1, 2}) {
    tbb::task_arena arena(threads);
    arena.execute([&] { skies.push_back(fitted(environment)); });
  }
  EXPECT_EQ(skies[0].bandwidth, skies[1].bandwidth);
  EXPECT_EQ(skies[0].center, skies[1].center);
  EXPECT_EQ(skies[0].coefficient, skies[1].coefficient);
}

TEST(EnvironmentMixture, TurnsWithTheWorld) {
  const Mat3 turn({0, 1, 0}, {-1, 0, 0}, {0, 0, 1});
  const EnvironmentMixture straight = fitted(image_of(two_lobes)), turned = fitted(image_of(two_lobes, turn));
  ASSERT_EQ(straight.size(), turned.size());
  for (size_t k = 0; k < turned.size(); ++k) {
    EXPECT_LT(glm::distance(turn * turned.center[k], straight.center[k]), 1e-5f);
  }
}

TEST(EnvironmentMixture, ConstantAndBlackSkies) {
  const EnvironmentMixture constant = fitted(Environment::constant({1, 2, 3}));
  ASSERT_EQ(constant.size(), 1u);
  EXPECT_EQ(constant.bandwidth[0], 0);
  EXPECT_EQ(constant.coefficient[0], Rgb(1, 2, 3));
  EXPECT_EQ(fitted(Environment()).size(), 0u);
  EXPECT_EQ(fitted(image_of([](const Vec3&) { return Rgb(0); })).size(), 0u);
}

TEST(EnvironmentMixture, StopsWhenCancelled) {
  Progress progress;
  progress.cancel();
  EXPECT_THROW(mixture_of_environment(image_of(two_lobes), {}, {}, progress), Error);
}

std::filesystem::path only_file(const std::filesystem::path& folder) {
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
  return std::filesystem::directory_iterator(folder)->path();
}

TEST(EnvironmentCache, GivesBackTheSameMixture) {
  const auto folder = test::scratch_folder() / "made";
  const Environment environment = image_of(two_lobes);
  const EnvironmentMixture first = fitted(environment, folder), second = fitted(environment, folder);
  EXPECT_FALSE(first.cached);
  EXPECT_TRUE(second.cached);
  EXPECT_EQ(first.bandwidth, second.bandwidth);
  EXPECT_EQ(first.coefficient, second.coefficient);
  EXPECT_EQ(first.relative_l2, second.relative_l2);
  EXPECT_TRUE(fitted(image_of(two_lobes, Mat3({0, 1, 0}, {-1, 0, 0}, {0, 0, 1})), folder).cached);
  only_file(folder);
  EXPECT_FALSE(fitted(image_of([](const Vec3& w) { return 2.0f * two_lobes(w); }), folder).cached);
}

TEST(EnvironmentCache, RefitsWhatIsCorrupt) {
  const auto folder = test::scratch_folder() / "made";
  const Environment environment = image_of(two_lobes);
  const EnvironmentMixture exact = fitted(environment, folder);
  const auto file = only_file(folder);
  const auto size = std::filesystem::file_size(file);
  for (const uint64_t kept : {uint64_t{0}, uint64_t{7}, size / 2, size - 1}) {
    std::filesystem::resize_file(file, kept);
    const EnvironmentMixture again = fitted(environment, folder);
    EXPECT_FALSE(again.cached) << kept;
    EXPECT_EQ(again.bandwidth, exact.bandwidth);
    EXPECT_EQ(std::filesystem::file_size(file), size);
  }
  std::ofstream(file, std::ios::trunc) << "not a picture at all";
  EXPECT_FALSE(fitted(environment, folder).cached);
  EXPECT_TRUE(fitted(environment, folder).cached);
}

TEST(EnvironmentCache, AFolderThatCannotBeIsNoError) {
  const auto folder = test::scratch_folder();
  std::ofstream(folder / "file") << "x";
  EXPECT_GT(fitted(image_of(two_lobes), folder / "file").size(), 0u);
}

TEST(EnvironmentMixture, UniformImagesOfAnySizeAreUniform) {
  for (const auto& [width, height] : {std::pair{1, 1}, {2, 1}, {1, 2}, {1, 3}, {1, 64}, {4, 2}, {16, 8}}) {
    const EnvironmentMixture sky = fitted(image_of([](const Vec3&) { return Rgb(2.0f); }, Mat3(1.0f), width, height));
    EXPECT_LT(sky.relative_l2, 0.1f) << width << " x " << height;  // false for NaN
    EXPECT_NEAR(energy(sky).g, 8 * kPi, 0.02f * 8 * kPi) << width << " x " << height;
  }
}

}  // namespace
}  // namespace velour::environment_mixture_test
