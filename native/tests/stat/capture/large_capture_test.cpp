// Captures of what is large: many triangles, many texels. What they may take is bounded.
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <string>
#include <thread>

#include "base/job.h"
#include "support/captured.h"
#include "support/level.h"

namespace velour::large_capture_test {
namespace {

using test::ScratchFolder;
using test::small_capture;
using test::tile_of;

/// Waves, of `quads` x `quads` squares.
Mesh waves(uint32_t quads) {
  std::vector<Vec3> positions;
  std::vector<glm::uvec3> triangles;
  for (uint32_t y = 0; y <= quads; ++y) {
    for (uint32_t x = 0; x <= quads; ++x) {
      const Vec2 p = Vec2(static_cast<float>(x), static_cast<float>(y)) / static_cast<float>(quads);
      positions.emplace_back(p, 0.03f * std::sin(2 * kPi * 7 * p.x) * std::sin(2 * kPi * 5 * p.y));
    }
  }
  for (uint32_t y = 0; y < quads; ++y) {
    for (uint32_t x = 0; x < quads; ++x) {
      const uint32_t a = y * (quads + 1) + x, b = a + quads + 1;
      triangles.emplace_back(a, a + 1, b + 1);
      triangles.emplace_back(a, b + 1, b);
    }
  }
  return Mesh({.positions = positions, .triangles = triangles});
}

/// The most that the process holds while this is there, above what it held before: as the kernel counts it, for a
/// thread that looks every now and then misses peaks on a busy machine.
class PeakMemory {
 public:
  PeakMemory() {
    malloc_trim(0);  // what tests before have left would be used again unseen
    std::ofstream reset("/proc/self/clear_refs");
    reset << "5" << std::flush;  // the peak begins anew [proc(5)]
    EXPECT_TRUE(reset.good());
    before_ = peak_kilobytes();
  }
  double megabytes() const { return (peak_kilobytes() - before_) * 1.024e-3; }

 private:
  static double peak_kilobytes() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
      if (line.starts_with("VmHWM:")) return std::stod(line.substr(6));
    }
    ADD_FAILURE() << "/proc/self/status has no VmHWM";
    return 0;
  }

  double before_;
};

/// CPU seconds per hardware thread until a cancelled job stops. Other load on the machine does not count.
double seconds_to_stop(Job& job) {
  const std::clock_t start = std::clock();
  job.cancel();
  EXPECT_TRUE(job.wait_for(60));
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / std::max(1u, std::thread::hardware_concurrency());
}

#ifndef __SANITIZE_ADDRESS__  // whose own bookkeeping takes several times as much

TEST(LargeCapture, OfTenMillionTrianglesHoldsThemOnceAndStopsSoon) {
  VELOUR_LONG_TEST();
  const auto scene = tile_of(waves(2237), std::make_shared<test::Lambert>(0.8f));
  const uint64_t triangles = scene->meshes()[0].triangles().size();
  ASSERT_GE(triangles, 10'000'000u);
  EXPECT_LT(scene->info().bytes, 200 * triangles);
  BtfCaptureOptions options = small_capture(bonn_directions(), bonn_directions());
  const ScratchFolder folder("triangles");
  const PeakMemory memory;
  std::vector<double> stops;
  for (int i = 0; i < 5; ++i) {
    Job job([&](Progress& progress) { capture_btf(*scene, options, folder.path(), progress); });
    job.start();
    job.wait_for(0.1 * i);
    stops.push_back(seconds_to_stop(job));
    options.resume = true;
  }
  std::nth_element(stops.begin(), stops.begin() + 2, stops.end());
  EXPECT_LT(stops[2], 0.05) << "seconds until a cancel has its way, median of five";
  options.views = options.lights = {{0, 0}, {60, 0}};
  const test::Captured captured(*scene, options, "of_many_triangles");
  EXPECT_LT(memory.megabytes(), 100) << "a second hierarchy alone would take a gigabyte";
  EXPECT_NEAR(captured.mean(0).mean, 0.8 / kPiD, 0.1 * 0.8 / kPiD);
}

/// A view of 1024 x 1024 texels under 64 lights: 403 MB, of which lights below the plane bring nothing.
double megabytes_of_a_large_view(uint64_t limit) {
  const auto scene = tile_of(test::Corners().rectangle(0, 0, 1, 1).mesh(), std::make_shared<test::Lambert>(0.5f));
  std::vector<PolarAngles> lights = ring_directions(60, 4);
  for (const PolarAngles& d : ring_directions(120, 60)) lights.push_back(d);
  BtfCaptureOptions options = small_capture({{0, 0}}, lights);
  options.texels[0] = options.texels[1] = 1024;
  options.sampling.samples = 1;
  options.sampling.bounces = 0;
  options.memory_limit = limit;
  const ScratchFolder folder("large_view");
  const PeakMemory memory;
  Progress progress;
  EXPECT_GT(capture_btf(*scene, options, folder.path(), progress).bytes, 403'000'000u);
  return memory.megabytes();
}

TEST(LargeCapture, KeepsToALimitOf256Megabytes) {
  EXPECT_LT(megabytes_of_a_large_view(uint64_t{1} << 28), 256);
  EXPECT_GT(megabytes_of_a_large_view(uint64_t{1} << 30), 400) << "control";
}

#endif

}  // namespace
}  // namespace velour::large_capture_test
