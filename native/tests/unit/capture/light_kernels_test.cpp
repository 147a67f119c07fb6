#include "capture/btf/view_capture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "math/sphere/directions.h"
#include "math/sphere/random.h"
#include "support/simd_targets.h"

namespace velour::light_kernels_test {
namespace {

/// Neither a multiple of any vector's length nor less than a group.
std::vector<CaptureLight> lights() {
  std::vector<CaptureLight> all;
  for (const Vec3& wl : sphere_fibonacci(101)) {
    all.push_back({wl, static_cast<uint32_t>(all.size()), 1 / std::abs(wl.z), {}});
  }
  return all;
}

TEST(LightKernels, FindWhoFacesALight) {
  for (const int count : {0, 1, 15, 16, 203}) {
    PlaceNormals normals;
    const std::vector<Vec3> directions = sphere_fibonacci(std::max(count, 1));
    const Vec3 wl = glm::normalize(Vec3(0.3f, -0.2f, 0.7f));
    std::vector<uint32_t> expected;
    for (uint32_t i = 0; i < static_cast<uint32_t>(count); ++i) {
      const Vec3 geometric = directions[i], shading = directions[(i * 7) % directions.size()];
      normals.push(geometric, shading);
      if (glm::dot(geometric, wl) > 0 && glm::dot(shading, wl) > 0) expected.push_back(i);
    }
    test::on_every_simd_target([&] {
      std::vector<uint32_t> numbers;
      facing_places(normals, wl, numbers);
      EXPECT_EQ(numbers, expected);
    });
  }
}

TEST(LightKernels, CollectTheLightsOfAMask) {
  const std::vector<CaptureLight> all = lights();
  const LightGroup group(all, 0);
  const Frame frame = Frame::about(glm::normalize(Vec3(1, 2, -3)));
  for (const uint64_t mask : {uint64_t{1}, uint64_t{1} << 63, ~uint64_t{0}, uint64_t{0x8000400000123456}}) {
    for (const uint32_t first : {0u, 64u}) {
      test::on_every_simd_target([&] {
        LitLights lit;
        collect_lit(group, first, mask, frame, lit);
        int count = 0;
        for (uint32_t l = 0; l < 64; ++l) {
          if ((mask >> l & 1) == 0) continue;
          const uint32_t number = first + l;
          const Vec3 wl = number < all.size() ? frame.to_local(all[number].wl) : Vec3(0);
          const float weight = number < all.size() ? wl.z * all[number].per_irradiance : 0;
          EXPECT_EQ(lit.number[count], number);
          EXPECT_EQ(lit.wl.get(count), wl);
          EXPECT_EQ(lit.weight[count++], weight);
        }
        EXPECT_EQ(lit.wl.count, count);
      });
    }
  }
}

TEST(LightKernels, AddPathsAndLeaveOutWhatIsNotFinite) {
  constexpr uint32_t kCount = 101;
  const Vec3 weights(0.2f, 0.7f, 0.1f);
  alignas(64) float path[3][kLightsTogether] = {};
  RandomStream random(1, 2, 3);
  for (uint32_t l = 0; l < kCount; ++l) {
    for (auto& channel : path) channel[l] = random.next();
  }
  path[1][5] = std::numeric_limits<float>::quiet_NaN();
  path[2][99] = std::numeric_limits<float>::infinity();
  test::on_every_simd_target([&] {
    PathSums sums{};
    for (int k = 0; k < 2; ++k) EXPECT_EQ(add_path(path, weights, kCount, sums), 2u);
    for (uint32_t l = 0; l < kCount; ++l) {
      const bool good = l != 5 && l != 99;
      const float y = weights.r * path[0][l] + weights.g * path[1][l] + weights.b * path[2][l];
      const double luminance = good ? static_cast<double>(y) : 0.0;
      EXPECT_EQ(sums.luminance[l], 2 * luminance);
      EXPECT_EQ(sums.luminance_sq[l], 2 * luminance * luminance);
      for (int c = 0; c < 3; ++c) EXPECT_EQ(sums.sum[c][l], good ? 2 * static_cast<double>(path[c][l]) : 0.0);
    }
  });
}

}  // namespace
}  // namespace velour::light_kernels_test
