// Texels about a place, and sums of their records.
#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "base/memory.h"
#include "btf/model/srbf_evaluator.h"
#include "image/texels.h"
#include "math/sphere/random.h"
#include "support/simd_targets.h"

namespace velour::texels_test {
namespace {

TEST(BilinearTexels, OfACenterIsThatTexel) {
  const BilinearTexels texels = bilinear_texels({2.5f / 4 + 3, 1.5f / 2 - 5}, 4, 2);
  EXPECT_EQ(texels.index[0], 1u * 4 + 2);
  EXPECT_NEAR(texels.weight[0], 1.0f, 1e-5f);
}

TEST(BilinearTexels, AtTheCornerOfTheTileAreItsFourCorners) {
  const BilinearTexels texels = bilinear_texels({0, 1}, 4, 3);
  EXPECT_EQ(std::set<uint32_t>(texels.index.begin(), texels.index.end()), (std::set<uint32_t>{0, 3, 8, 11}));
  for (const float weight : texels.weight) EXPECT_EQ(weight, 0.25f);
}

TEST(BilinearTexels, AreInsideAndWeighOne) {
  for (const auto& [width, height] : {std::pair(1u, 1u), {1u, 5u}, {7u, 3u}}) {
    for (uint64_t i = 0; i < 1000; ++i) {
      RandomStream random(1, i, 0);
      // Also places just below a whole number, which rounding may take to it.
      const Vec2 place = i % 10 == 0 ? Vec2(-1e-9f, -1e-20f) : (random.next2() - 0.5f) * 1000.0f;
      const BilinearTexels texels = bilinear_texels(place, width, height);
      float sum = 0;
      for (size_t c = 0; c < 4; ++c) {
        EXPECT_LT(texels.index[c], width * height);
        EXPECT_GE(texels.weight[c], 0.0f);
        sum += texels.weight[c];
      }
      EXPECT_NEAR(sum, 1.0f, 1e-5f);
    }
  }
}

/// A level without relief: a view meets it where it looks.
struct FlatLevel {
  Vec2 size;
  Vec2 texels() const { return size; }
  Vec2 seen_texel(const Vec2& place, const Vec3& /*wv*/) const { return place * size - 0.5f; }
};

TEST(SeenLevels, ShowTheSamePlace) {
  const std::vector<FlatLevel> levels = {{{8, 6}}, {{4, 3}}, {{2, 1}}};
  const Vec3 wv(0, 0, 1);
  for (const Vec2 place : {Vec2(0.5f, 0.25f), Vec2(0.01f, 0.99f), Vec2(0.3f, 0.7f)}) {
    for (const size_t fine : {0u, 1u}) {
      const SeenLevels seen = seen_levels(levels, place + Vec2(3, -2), static_cast<float>(fine) + 0.25f, wv);
      EXPECT_EQ(seen.fine, fine);
      EXPECT_EQ(seen.part, 0.25f);
      EXPECT_LT(glm::length(seen.texel - levels[fine].seen_texel(place, wv)), 1e-5f);
      EXPECT_LT(glm::length(seen.coarse - levels[fine + 1].seen_texel(place, wv)), 1e-5f);
    }
  }
}

TEST(ByteTexels, AddWhatTheyWeighInSteps) {
  constexpr uint32_t kWidth = 5, kHeight = 3, kStride = 3 * kByteRowPadding;
  RandomStream random(2, 0, 0);
  std::vector<uint8_t> bytes(size_t{kWidth} * kHeight * kStride);
  for (uint8_t& b : bytes) b = static_cast<uint8_t>(256 * random.next());
  bytes[7] = 255;
  AlignedArray<float> step(kStride), to(kStride);
  for (uint32_t k = 0; k < kStride; ++k) step.data()[k] = 0.01f * random.next();
  test::on_every_simd_target([&] {
    for (const Vec2& texel : {Vec2(-0.3f, 2.4f), Vec2(1.7f, 0.2f), Vec2(-7.0f, 30.5f)}) {
      std::fill_n(to.data(), kStride, 7.0f);
      add_bilinear_bytes({bytes.data(), kWidth, kHeight, kStride}, texel, 0.75f, step.data(), to.data());
      const BilinearTexels corner = bilinear_at(texel, kWidth, kHeight);
      for (uint32_t k = 0; k < kStride; ++k) {
        double mean = 0;
        for (size_t i = 0; i < 4; ++i) {
          mean += static_cast<double>(corner.weight[i]) * bytes[size_t{corner.index[i]} * kStride + k];
        }
        const double expected = 7 + 0.75 * static_cast<double>(step.data()[k]) * mean;
        EXPECT_NEAR(static_cast<double>(to.data()[k]), expected, 1e-5);
      }
    }
  });
}

}  // namespace
}  // namespace velour::texels_test
