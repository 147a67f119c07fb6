#include "btf/measure/half_floats.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "image/tensors/exr_tensors.h"
#include "support/simd_targets.h"

namespace velour::half_floats_test {
namespace {

TEST(HalfFloats, EveryHalfSurvivesTheWayThereAndBack) {
  std::vector<HalfBits> all(65536);
  for (size_t i = 0; i < all.size(); ++i) all[i] = static_cast<HalfBits>(i);
  std::vector<float> floats(all.size());
  std::vector<HalfBits> back(all.size());
  test::on_every_simd_target([&] {
    halves_to_floats(all, floats);
    floats_to_halves(floats, back);
    for (size_t i = 0; i < all.size(); ++i) {
      if (!std::isnan(floats[i])) {
        ASSERT_EQ(back[i], all[i]) << i;
      }
    }
  });
}

TEST(HalfFloats, OneByOneTheyAreTheSame) {
  for (uint32_t bits = 0; bits < 65536; ++bits) {
    const auto half = static_cast<HalfBits>(bits);
    float together = 0;
    halves_to_floats({&half, 1}, {&together, 1});
    if (std::isfinite(together)) {
      ASSERT_EQ(std::bit_cast<uint32_t>(finite_half_to_float(half)), std::bit_cast<uint32_t>(together)) << bits;
    }
  }
}

TEST(HalfFloats, RoundAsTheFilesDo) {
  std::vector<float> floats;
  for (float x = 1e-9f; x < 1e6f; x *= 1.0007f) floats.insert(floats.end(), {x, -x});
  floats.push_back(65519.9f);  // the last that is not infinite
  floats.push_back(65520.0f);
  floats.push_back(1.0f + 0x1p-11f);  // ties go to even
  floats.push_back(1.0f + 3 * 0x1p-11f);
  std::vector<HalfBits> halves(floats.size());
  std::vector<float> rounded(floats.size());
  test::on_every_simd_target([&] {
    floats_to_halves(floats, halves);
    halves_to_floats(halves, rounded);
    for (size_t i = 0; i < floats.size(); ++i) {
      ASSERT_EQ(rounded[i], rounded_to_half(floats[i])) << floats[i];
    }
  });
}

}  // namespace
}  // namespace velour::half_floats_test
