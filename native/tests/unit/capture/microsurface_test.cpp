#include "capture/goniometer/microsurface.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <thread>

#include "base/file.h"
#include "brdf/measure/measurement.h"
#include "math/sphere/directions.h"
#include "support/level.h"
#include "support/test_data.h"

namespace velour::microsurface_test {
namespace {

MicrosurfaceOptions quick() {
  MicrosurfaceOptions options;
  options.rays = 200'000;
  return options;
}

std::string sentence_of(const MicrosurfaceOptions& options) {
  Progress progress;
  try {
    capture_microsurface(options, (test::scratch_folder() / "never.binary").string(), progress);
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::invalid_argument);
    return error.what();
  }
  return "";
}

TEST(Microsurface, RefusesNumbersOutOfRangeWithASentence) {
  const auto refused = [](auto change, const char* word) {
    MicrosurfaceOptions options = quick();
    change(options);
    EXPECT_NE(sentence_of(options).find(word), std::string::npos) << word;
  };
  refused([](auto& o) { o.roughness = 0.005; }, "0.005");
  refused([](auto& o) { o.roughness = 1.5; }, "roughness");
  refused([](auto& o) { o.roughness = std::nan(""); }, "roughness");
  refused([](auto& o) { o.anisotropy = 0.5; }, "anisotropy");
  refused([](auto& o) { o.anisotropy = 11; }, "anisotropy");
  refused([](auto& o) { o.base_share = 1.1; }, "base share");
  refused([](auto& o) { o.base_albedo.g = -0.1f; }, "base albedo");
  refused([](auto& o) { o.metal = "mithril"; }, "mithril");
  refused([](auto& o) { o.ior = 1.0; }, "refractive index");
  refused([](auto& o) { o.ior = 1.5, o.flake_roughness = 0.5; }, "flake roughness");
  refused([](auto& o) { o.threads = -1; }, "threads");
  refused([](auto& o) { o.rays = ~0ULL; }, "rays");
}

void expect_sound(const Measurement& measurement) {
  EXPECT_EQ(measurement.counts().invalid(), 0u);
  EXPECT_GT(measurement.counts().valid, 0u);
  const std::vector<Vec3> lights = hemisphere_fibonacci(500);
  std::vector<Rgb> f(lights.size());
  std::vector<uint8_t> valid(lights.size());
  for (const float theta_v : {0.0f, 0.5f, 1.3f, 1.5f}) {
    measurement.eval(direction(theta_v, 0.4f), lights, f, valid);
    for (const Rgb& value : f) {
      for (int c = 0; c < 3; ++c) ASSERT_TRUE(std::isfinite(value[c]) && value[c] >= 0.0f);
    }
  }
}

TEST(Microsurface, WritesAMerlFileThatLoads) {
  const std::string path = (test::scratch_folder() / "copper.binary").string();
  Progress progress;
  const MicrosurfaceReport report = capture_microsurface(quick(), path, progress);
  const auto measurement = load_measurement(path);
  EXPECT_EQ(measurement->provenance().format, "merl");
  EXPECT_TRUE(measurement->isotropic());
  expect_sound(*measurement);
  EXPECT_EQ(report.bytes, std::filesystem::file_size(path));
  EXPECT_GT(report.rays, 200'000u);
  EXPECT_GT(report.seconds, 0.0);
  EXPECT_GT(report.relative_standard_error, 0.0);
  EXPECT_LT(report.relative_standard_error, 0.1);
  EXPECT_NEAR(report.resolution_degrees, 0.955, 0.01);
  EXPECT_GT(report.albedo[0], report.albedo[2]);  // copper
  EXPECT_LT(report.albedo[0], 1.0);
  EXPECT_EQ(progress.fraction(), 1.0);
}

TEST(Microsurface, WritesATableWithBothAzimuths) {
  const std::string path = (test::scratch_folder() / "brushed.exr").string();
  MicrosurfaceOptions options = quick();
  options.anisotropy = 4;
  Progress progress;
  capture_microsurface(options, path, progress);
  const auto measurement = load_measurement(path);
  EXPECT_FALSE(measurement->isotropic());
  expect_sound(*measurement);
  // From above, the highlight is wide along x and narrow along y.
  const std::vector<Vec3> lights{direction(0.3f, 0), direction(0.3f, 0.5f * kPi)};
  std::vector<Rgb> f(2);
  std::vector<uint8_t> valid(2);
  measurement->eval({0, 0, 1}, lights, f, valid);
  EXPECT_GT(f[0].r, 10 * f[1].r);
}

TEST(Microsurface, ABareBaseHasItsColorAlone) {
  const std::string path = (test::scratch_folder() / "base.binary").string();
  MicrosurfaceOptions options = quick();
  options.base_share = 1;
  options.base_albedo = {0.2f, 0.4f, 0.8f};
  options.roughness = 0.01;
  Progress progress;
  const MicrosurfaceReport report = capture_microsurface(options, path, progress);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(report.albedo[c], static_cast<double>(options.base_albedo[c]), 0.02);
}

TEST(Microsurface, ACoatedBaseHasItsColorBelowAGrayHighlight) {
  const std::string path = (test::scratch_folder() / "plastic.binary").string();
  MicrosurfaceOptions options = quick();
  options.ior = 1.5;
  options.base_share = 1;
  options.base_albedo = {0.9f, 0.3f, 0.0f};
  Progress progress;
  const MicrosurfaceReport report = capture_microsurface(options, path, progress);
  EXPECT_GT(report.albedo[0], 0.6);
  EXPECT_NEAR(report.albedo[2], 0.04, 0.01);  // the surface alone
  EXPECT_GT(report.albedo[0], report.albedo[1] + 0.2);
}

TEST(Microsurface, TheSameBytesForAnyNumberOfThreads) {
  for (const double anisotropy : {1.0, 2.0}) {
    if (anisotropy == 1 && !test::long_tests()) continue;
    std::string hash[2];
    for (int threads : {1, 4}) {
      const std::string path = (test::scratch_folder() / "same").string();
      MicrosurfaceOptions options = quick();
      options.threads = threads;
      options.anisotropy = anisotropy;
      options.base_share = 0.3;
      options.base_albedo = Rgb(0.5f);
      Progress progress;
      capture_microsurface(options, path, progress);
      hash[threads == 1 ? 0 : 1] = sha256_hex(read_file(path));
    }
    EXPECT_EQ(hash[0], hash[1]);
  }
}

TEST(Microsurface, AnotherSeedIsAnotherSurface) {
  std::string hash[2];
  for (uint64_t seed : {0, 1}) {
    const std::string path = (test::scratch_folder() / "seed").string();
    MicrosurfaceOptions options = quick();
    options.seed = seed;
    Progress progress;
    capture_microsurface(options, path, progress);
    hash[seed] = sha256_hex(read_file(path));
  }
  EXPECT_NE(hash[0], hash[1]);
}

TEST(Microsurface, StopsSoonAfterACancelAndWritesNothing) {
  const std::string path = (test::scratch_folder() / "cancelled.binary").string();
  MicrosurfaceOptions options;
  options.rays = 1'000'000'000;
  Progress progress;
  Status status = Status::ok;
  std::chrono::steady_clock::time_point stopped;
  std::thread job([&] {
    try {
      capture_microsurface(options, path, progress);
    } catch (const Error& error) {
      status = error.status();
    }
    stopped = std::chrono::steady_clock::now();
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  const auto asked = std::chrono::steady_clock::now();
  progress.cancel();
  job.join();
  EXPECT_EQ(status, Status::cancelled);
  // 0.1 s on an idle machine; tests run beside others.
  EXPECT_LT(std::chrono::duration<double>(stopped - asked).count(), 0.5);
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace velour::microsurface_test
