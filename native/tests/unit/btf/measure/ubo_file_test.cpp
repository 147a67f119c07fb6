#include "btf/formats/ubo_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "base/file.h"
#include "btf_support.h"
#include "support/test_data.h"
#include "ubo_support.h"

namespace velour::ubo_file_test {
namespace {

using test::message_of;
using test::UboExample;

class UboFileTest : public ::testing::Test {
 protected:
  std::shared_ptr<const BtfMeasurement> load(const UboExample& example, const BtfLoadOptions& options = {}) const {
    write_file(path_, example.bytes());
    return load_btf(path_, options);
  }
  std::string refusal(std::vector<uint8_t> bytes) const {
    write_file(path_, bytes);
    const std::string message = message_of([&] { load_btf(path_); });
    return message.empty() ? "" : message.substr(path_.size());
  }
  std::string path_ = test::scratch_folder() / "carpet.btf";
};

UboExample example(uint64_t seed) {
  UboExample e;
  e.randomize(seed);
  return e;
}

using Decode = std::array<double, 3> (*)(const std::array<double, 3>&);

/// `row_of_pair`: rows in the order of the layout's pairs.
void expect_decoded(const BtfMeasurement& btf, const UboExample& e, const std::vector<uint64_t>& row_of_pair,
                    const Decode& decode, double scale = 1) {
  const std::vector<HalfBits> halves = test::all_pairs(btf);
  std::vector<float> values(halves.size());
  halves_to_floats(halves, values);
  ASSERT_EQ(btf.layout().pairs(), row_of_pair.size());
  for (uint64_t pair = 0; pair < row_of_pair.size(); ++pair) {
    for (uint64_t texel = 0; texel < uint64_t{e.width} * e.height; ++texel) {
      const auto expected = decode({e.channel(0, row_of_pair[pair], texel), e.channel(1, row_of_pair[pair], texel),
                                    e.channel(2, row_of_pair[pair], texel)});
      const uint64_t x = texel % e.width, y = e.height - 1 - texel / e.width;
      for (size_t c = 0; c < 3; ++c) {
        const double found = double{values[((pair * e.height + y) * e.width + x) * 3 + c]};
        EXPECT_NEAR(found, scale * expected[c], 1e-3 * std::abs(scale * expected[c]) + 1e-5) << pair << ' ' << texel;
      }
    }
  }
}

std::array<double, 3> same(const std::array<double, 3>& c) { return c; }
std::array<double, 3> from_yuv(const std::array<double, 3>& c) {
  return {c[0] + 1.13983 * c[2], c[0] - 0.39465 * c[1] - 0.5806 * c[2], c[0] + 2.03211 * c[1]};
}
std::array<double, 3> from_log_y(const std::array<double, 3>& c) {
  return from_yuv({std::exp(c[0]) - 1e-5, c[1], c[2]});
}
std::array<double, 3> from_ratios(const std::array<double, 3>& c) {
  return from_yuv({std::exp(c[0]) - 1e-5, c[1] * std::exp(c[0]), c[2] * std::exp(c[0])});
}
std::array<double, 3> from_log_rgb(const std::array<double, 3>& c) {
  return {std::exp(c[0]) - 1e-5, std::exp(c[1]) - 1e-5, std::exp(c[2]) - 1e-5};
}

TEST_F(UboFileTest, MultipliesItsFactors) {
  for (const bool texels_first : {false, true}) {
    for (const uint8_t scalar_bytes : {uint8_t{2}, uint8_t{4}, uint8_t{8}}) {
      UboExample e = example(scalar_bytes);
      e.texels_first = texels_first;
      e.scalar_bytes = scalar_bytes;
      const auto btf = load(e);
      expect_decoded(*btf, e, {0, 1, 2, 3}, same);
      EXPECT_EQ(btf->provenance().format, "ubo2014");
      EXPECT_EQ(btf->provenance().description, "test setup");
      EXPECT_EQ(btf->layout().views().size(), 2u);
      EXPECT_NEAR(btf->layout().lights()[1].phi, 120, 1e-5);
      EXPECT_EQ(btf->grid().tile_metres, Vec2(0.002f, 0.0015f));
    }
  }
}

TEST_F(UboFileTest, KnowsItsColors) {
  UboExample e = example(7);
  const std::pair<int32_t, Decode> models[] = {
      {0, same}, {1, from_yuv}, {9, from_log_y}, {11, from_ratios}, {12, from_log_rgb}};
  for (const auto& [model, decode] : models) {
    e.color_model = model;
    expect_decoded(*load(e), e, {0, 1, 2, 3}, decode);
  }
  e.color_model = 3;
  EXPECT_EQ(refusal(e.bytes()), ": has color model 3; only 0, 1, 9, 11 and 12 are supported.");
}

TEST_F(UboFileTest, EarlierVersionsLackFields) {
  for (const uint32_t version : {1u, 2u, 3u, 4u}) {
    UboExample e = example(8);
    e.version = version;
    expect_decoded(*load(e), e, {0, 1, 2, 3}, same);
  }
}

TEST_F(UboFileTest, TheCosineIsTakenOutWhereItIsIn) {
  UboExample e = example(9);
  e.lights = {{{60, 0}, {60, 120}}, {{60, 0}, {60, 120}}};
  e.cosine = 1;
  expect_decoded(*load(e), e, {0, 1, 2, 3}, same, 2);
  BtfLoadOptions options;
  options.values = BtfValues::reflectance;  // what the caller says overrides what the file says
  expect_decoded(*load(e, options), e, {0, 1, 2, 3}, same, 1 / M_PI);
}

TEST_F(UboFileTest, ViewsMayHaveLightsOfTheirOwn) {
  UboExample e;
  e.lights = {{{60, 0}, {30, 0}}, {{30, 0}, {70, 0}, {60, 0}}};
  e.randomize(10);
  const auto btf = load(e);
  EXPECT_FALSE(btf->layout().complete());
  // Lights are numbered as they are met: 60, 30, 70 degrees.
  expect_decoded(*btf, e, {0, 1, 4, 2, 3}, same);
}

TEST_F(UboFileTest, APairHasTheSameBitsInEveryRange) {
  UboExample e;
  e.width = 37;
  e.height = 70;  // several blocks
  e.components = {60, 31, 30};
  e.randomize(11);
  const auto btf = load(e);
  const std::vector<HalfBits> all = test::all_pairs(*btf);
  const uint64_t image = btf->grid().texels() * 3;
  for (uint64_t pair = 0; pair < 4; ++pair) {
    std::vector<HalfBits> one(image);
    btf->read_pairs(pair, 1, one);
    EXPECT_TRUE(std::equal(one.begin(), one.end(), all.begin() + static_cast<ptrdiff_t>(pair * image)));
  }
}

TEST_F(UboFileTest, WhatIsWrongIsOneSentence) {
  std::vector<uint8_t> good = example(12).bytes();
  std::vector<uint8_t> bytes = good;
  std::copy_n("!FMF12FCER", 10, bytes.begin());
  EXPECT_EQ(refusal(bytes),
            ": is a BTF file of the University of Bonn with signature '!FMF12FCER'; only '!DFMF08FCR' (UBO2014) is "
            "supported.");
  bytes.assign(good.begin(), good.end() - 1);
  EXPECT_EQ(refusal(bytes), ": the right factor needs 24 bytes at byte " + std::to_string(good.size() - 24) +
                                ", but the file holds " + std::to_string(good.size() - 1) +
                                "; it is truncated or damaged. Download it again.");
  bytes = good;
  bytes[10] ^= 1;
  EXPECT_NE(refusal(bytes).find("the description has"), std::string::npos);
  UboExample e = example(13);
  e.views[1].theta = 90;
  EXPECT_NE(refusal(e.bytes()).find("differ from 90 by at least 0.1"), std::string::npos);
  e = example(13);
  e.lights[0][1] = e.lights[0][0];
  EXPECT_EQ(refusal(e.bytes()), ": a view has the same light more than once; the file is damaged.");
  e = example(13);
  e.height = 4;
  EXPECT_EQ(refusal(e.bytes()), ": has factors of 4 and 12 rows, but there are 4 view-light pairs and 16 texels.");
}

/// A fit would otherwise run before its model turned out to be too large.
TEST_F(UboFileTest, MoreLightsThanAModelHasAreRefused) {
  UboExample e = example(14);
  e.components = {1, 1, 1};
  for (size_t v = 0; v < 2; ++v) {
    e.lights[v].clear();
    for (int i = 0; i < 3000; ++i) e.lights[v].push_back({0.02 * i, v == 0 ? 0.0 : 90.0});
  }
  e.randomize(14);
  EXPECT_EQ(refusal(e.bytes()),
            ": has 2 views and, in all, 6000 different lights; at most 4096 of each are supported.");
}

}  // namespace
}  // namespace velour::ubo_file_test
