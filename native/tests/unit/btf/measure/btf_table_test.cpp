#include "btf/eval/measured_btf_material.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "support/striped_btf.h"

namespace velour::btf_table_test {
namespace {

const TexelGrid kGrid{6, 5};

/// One value of a table.
float at(const BtfTable& table, size_t level, uint32_t view, uint64_t texel, size_t light, size_t channel) {
  return finite_half_to_float(table.row(level, view, texel)[3 * light + channel]);
}

double mean_of_level(const BtfTable& table, size_t level, uint32_t view, size_t light, size_t channel) {
  const uint64_t texels = uint64_t{table.levels[level].width} * table.levels[level].height;
  double sum = 0;
  for (uint64_t t = 0; t < texels; ++t) sum += static_cast<double>(at(table, level, view, t, light, channel));
  return sum / static_cast<double>(texels);
}

TEST(BtfTable, HoldsEveryEntryBitForBit) {
  const test::MemoryBtf btf = test::striped_btf(kGrid);
  const auto table = read_btf_table(btf);
  std::vector<HalfBits> image(kGrid.texels() * 3);
  for (uint64_t pair = 0; pair < btf.layout().pairs(); ++pair) {
    btf.read_pairs(pair, 1, image);
    const size_t light = btf.layout().light_of(pair);
    for (uint64_t t = 0; t < kGrid.texels(); ++t) {
      const HalfBits* rgb = table->row(0, btf.layout().view_of(pair), t) + 3 * light;
      for (size_t c = 0; c < 3; ++c) ASSERT_EQ(rgb[c], image[3 * t + c]) << pair << ' ' << t;
    }
  }
}

TEST(BtfTable, MipLevelsKeepTheMeanOfEveryPair) {
  const test::MemoryBtf btf = test::striped_btf(kGrid);
  const auto table = read_btf_table(btf);
  ASSERT_EQ(table->levels.size(), 3u);  // 6 x 5, 3 x 2, 1 x 1
  for (uint64_t pair = 0; pair < btf.layout().pairs(); ++pair) {
    const uint32_t view = btf.layout().view_of(pair), light = btf.layout().light_of(pair);
    for (size_t c = 0; c < 3; ++c) {
      const double mean = mean_of_level(*table, 0, view, light, c);
      for (size_t l = 1; l < table->levels.size(); ++l) {
        ASSERT_NEAR(mean_of_level(*table, l, view, light, c), mean, 6e-4 * mean) << pair << ' ' << l;
      }
    }
  }
}

TEST(BtfTable, EntriesThatAreNotFiniteAreTheMeanOfTheirImage) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto holes = [&](const DirectionPair&, uint32_t x, uint32_t) {
    return x == 1 ? Rgb(nan, 1, std::numeric_limits<float>::infinity()) : Rgb(0.5f, 1, 2);
  };
  const auto table = read_btf_table(test::MemoryBtf(test::ringed_layout(), kGrid, holes));
  for (size_t level = 0; level < 3; ++level) {
    EXPECT_EQ(at(*table, level, 2, 0, 4, 0), 0.5f);
    EXPECT_EQ(at(*table, level, 2, 0, 4, 1), 1.0f);
    EXPECT_EQ(at(*table, level, 2, 0, 4, 2), 2.0f);
  }
  EXPECT_EQ(at(*table, 0, 2, 1, 4, 0), 0.5f);
}

TEST(BtfTable, WhatIsTooLargeIsRefusedBeforeItIsRead) {
  class Unreadable final : public BtfMeasurement {
   public:
    Unreadable() {
      layout_ = test::ringed_layout();
      grid_ = {4096, 4096};
      provenance_.path = "huge.btf";
    }
    void read_pairs(uint64_t, uint64_t, std::span<HalfBits>) const override { FAIL() << "it was read"; }
  };
  try {
    read_btf_table(Unreadable());
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::unsupported);
    EXPECT_NE(std::string(error.what()).find("huge.btf"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("the limit is 4.29 GB"), std::string::npos) << error.what();
  }
}

TEST(BtfTable, TheLimitIsThatOfAllLevels) {
  const test::MemoryBtf btf = test::striped_btf(kGrid);
  const uint64_t bytes = btf.layout().pairs() * (30 + 6 + 1) * 6;
  EXPECT_NO_THROW(read_btf_table(btf, bytes));
  EXPECT_THROW(read_btf_table(btf, bytes - 1), Error);
}

TEST(BtfTable, MissingPairsAreRefused) {
  const PairLayout two({{0, 0}, {30, 0}}, {{0, 0}, {30, 0}}, {{0, 1}, {1}});
  EXPECT_THROW(read_btf_table(test::MemoryBtf(two, kGrid, test::striped)), Error);
}

}  // namespace
}  // namespace velour::btf_table_test
