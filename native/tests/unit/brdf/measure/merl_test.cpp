#include "brdf/formats/merl.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "base/file.h"
#include "brdf/measure/brdf_table.h"
#include "measurement_support.h"
#include "support/inputs.h"
#include "support/test_data.h"

namespace velour::merl_test {
namespace {

/// f at every node; below the horizon something that must never be seen.
std::vector<double> planes_of(const std::function<Rgb(const Vec3&, const Vec3&)>& f) {
  std::vector<double> planes(3 * MerlGrid::size, 1e6);
  for (int i = 0; i < MerlGrid::theta_h; ++i)
    for (int j = 0; j < MerlGrid::theta_d; ++j)
      for (int k = 0; k < MerlGrid::phi_d; ++k) {
        const DirectionPair pair = MerlGrid::pair(i, j, k);
        if (pair.wl.z <= 0.0f || pair.wv.z <= 0.0f) continue;
        const Rgb value = f(pair.wl, pair.wv);
        for (int c = 0; c < 3; ++c)
          planes[static_cast<size_t>(c) * MerlGrid::size + MerlGrid::index(i, j, k)] = double{value[c]};
      }
  return planes;
}

class Merl : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const auto folder = test::scratch_root() / "Merl";
    std::filesystem::create_directories(folder);
    path_ = folder / "glossy.binary";
    write_merl(path_, planes_of(test::glossy));
    bytes_ = read_file(path_);
    measurement_ = load_measurement(path_);
  }
  static void TearDownTestSuite() {
    measurement_.reset();
    bytes_ = {};
  }
  static std::shared_ptr<const Measurement> read(const std::vector<uint8_t>& bytes) {
    return read_merl(bytes, test::provenance_named("bad.binary"));
  }
  /// Replaces the stored value of one channel of a node.
  static void store(std::vector<uint8_t>& bytes, size_t channel, size_t index, double value) {
    std::memcpy(&bytes.at(12 + 8 * (channel * MerlGrid::size + index)), &value, 8);
  }

  static std::string path_;
  static std::vector<uint8_t> bytes_;
  static std::shared_ptr<const Measurement> measurement_;
};
std::string Merl::path_;
std::vector<uint8_t> Merl::bytes_;
std::shared_ptr<const Measurement> Merl::measurement_;

TEST_F(Merl, LayoutOfTheFile) {
  ASSERT_EQ(bytes_.size(), 34992012u);
  double stored[3];
  const size_t index = MerlGrid::index(3, 20, 90);
  for (size_t c = 0; c < 3; ++c) std::memcpy(&stored[c], &bytes_[12 + 8 * (c * MerlGrid::size + index)], 8);
  const DirectionPair pair = MerlGrid::pair(3, 20, 90);
  const Rgb f = test::glossy(pair.wl, pair.wv);
  EXPECT_NEAR(stored[0] * (1.0 / 1500), double{f.r}, 1e-9);
  EXPECT_NEAR(stored[1] * (1.15 / 1500), double{f.g}, 1e-9);
  EXPECT_NEAR(stored[2] * (1.66 / 1500), double{f.b}, 1e-9);
  EXPECT_NEAR(std::acos(pair.wl.z * 0.5 + pair.wv.z * 0.5), std::acos(std::cos(0.1 * kPiD / 180) * std::cos(kPiD / 9)),
              1e-6);
}

TEST_F(Merl, EvaluatesTheBrdfThatWasTabulated) {
  double error = 0, total = 0;
  for (const auto& [wl, wv] : test::random_pairs(20000, 5, 0.1f)) {
    const auto [f, valid] = test::eval_one(*measurement_, wl, wv);
    ASSERT_TRUE(valid);
    const Rgb d = f - test::glossy(wl, wv);
    error += double{glm::dot(d, d)};
    total += double{glm::dot(test::glossy(wl, wv), test::glossy(wl, wv))};
  }
  EXPECT_LT(std::sqrt(error / total), 1e-3);
}

TEST_F(Merl, IsotropicAndReciprocal) {
  EXPECT_TRUE(measurement_->isotropic());
  for (const auto& [wl, wv] : test::random_pairs(3000, 6)) {
    const Rgb f = test::eval_one(*measurement_, wl, wv).f;
    const Rgb exchanged = test::eval_one(*measurement_, wv, wl).f;
    const Rgb turned = test::eval_one(*measurement_, test::rotated(wl, 1.1f), test::rotated(wv, 1.1f)).f;
    EXPECT_LT(glm::length(f - exchanged), 1e-4f * (0.1f + glm::length(f)));
    EXPECT_LT(glm::length(f - turned), 1e-3f * (0.1f + glm::length(f)));
  }
}

TEST_F(Merl, NoNumberIsLostAtTheEdges) {
  const Vec3 n(0, 0, 1), low = direction(1.5707f, 0), opposite = direction(1.5707f, kPi);
  for (const auto& [wl, wv] :
       {std::pair{n, n}, {low, low}, {low, opposite}, {direction(0.7f, 2), direction(0.7f, 2)}}) {
    const auto [f, valid] = test::eval_one(*measurement_, wl, wv);
    EXPECT_TRUE(std::isfinite(f.r + f.g + f.b));
    EXPECT_LT(f.r, 10.0f);  // nothing of the 1e6 below the horizon
  }
  EXPECT_FALSE(test::eval_one(*measurement_, Vec3(1, 0, 0), n).valid);
  EXPECT_FALSE(test::eval_one(*measurement_, n, Vec3(0, 0, -1)).valid);
  EXPECT_EQ(test::eval_one(*measurement_, Vec3(1, 0, 0), n).f, Rgb(0.0f));
}

TEST_F(Merl, CountsAddUp) {
  const EntryCounts& counts = measurement_->counts();
  EXPECT_EQ(counts.total, MerlGrid::size);
  EXPECT_EQ(counts.total, counts.valid + counts.invalid() + counts.below_horizon);
  EXPECT_EQ(counts.invalid(), 0u);
  EXPECT_GT(counts.below_horizon, 300000u);
  EXPECT_TRUE(measurement_->covers_view(0.0f));
  EXPECT_TRUE(measurement_->covers_view(radians_from(85.0f)));
  EXPECT_FALSE(measurement_->covers_view(kPi / 2));
}

TEST_F(Merl, AnyNegativeChannelIsInvalid) {
  auto bytes = bytes_;
  store(bytes, 2, MerlGrid::index(5, 10, 0), -1e-9);
  store(bytes, 0, MerlGrid::index(6, 10, 0), NAN);
  store(bytes, 1, MerlGrid::index(7, 10, 0), INFINITY);
  const auto read_back = read(bytes);
  EXPECT_EQ(read_back->counts().negative, 1u);
  EXPECT_EQ(read_back->counts().not_finite, 2u);
  EXPECT_EQ(read_back->counts().out_of_gamut, 0u);
  // The hole is closed by its neighbors, not by the bad value.
  const DirectionPair pair = pair_of_half_diff(radians_from(25.2 / 90), 0.0, radians_from(10.1), radians_from(0.1));
  const Rgb there = test::eval_one(*read_back, pair.wl, pair.wv).f, truth = test::glossy(pair.wl, pair.wv);
  EXPECT_LT(glm::length(there - truth), 0.2f * glm::length(truth));
}

TEST_F(Merl, NothingValidIsNotCovered) {
  write_merl(path_ + ".none", std::vector<double>(3 * MerlGrid::size, NAN));
  const auto none = load_measurement(path_ + ".none");
  EXPECT_EQ(none->counts().valid, 0u);
  EXPECT_FALSE(none->covers_view(0.3f));
  EXPECT_FALSE(test::eval_one(*none, direction(0.3f, 0), direction(0.3f, kPi)).valid);
}

TEST_F(Merl, RefusesTruncatedOversizedAndLyingFiles) {
  for (const size_t size : {0u, 1u, 11u, 12u, 13u, 4096u, 34992011u}) {
    const std::vector<uint8_t> cut(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_NE(test::refusal([&] { read(cut); }).find("bad.binary"), std::string::npos) << size;
  }
  auto longer = bytes_;
  longer.push_back(0);
  EXPECT_NE(test::refusal([&] { read(longer); }).find("34992013"), std::string::npos);
  for (const int32_t dimension : {0, -1, 91, 0x7fffffff}) {
    auto lying = bytes_;
    std::memcpy(&lying[4], &dimension, 4);
    EXPECT_NE(test::refusal([&] { read(lying); }).find("theta_diff"), std::string::npos) << dimension;
  }
}

/// A table as a program of another machine writes it: numbers of T, of `counts` nodes.
template <typename T>
std::vector<uint8_t> table_of(const std::array<int32_t, 3>& counts, bool is_big_endian) {
  std::vector<uint8_t> bytes;
  const auto append = [&](auto number) {
    auto raw = std::bit_cast<std::array<uint8_t, sizeof number>>(number);
    if (is_big_endian) std::ranges::reverse(raw);
    bytes.insert(bytes.end(), raw.begin(), raw.end());
  };
  for (const int32_t count : counts) append(count);
  const BrdfTableLayout layout{.theta_h = counts[0], .phi_h = 1, .theta_d = counts[1], .phi_d = counts[2]};
  constexpr double kScale[] = {1500, 1500 / 1.15, 1500 / 1.66};
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < counts[0]; ++i)
      for (int j = 0; j < counts[1]; ++j)
        for (int k = 0; k < counts[2]; ++k) {
          const DirectionPair pair = layout.pair(i, 0, j, k);
          const bool is_above = pair.wl.z > 0.0f && pair.wv.z > 0.0f;
          append(static_cast<T>(is_above ? double{test::glossy(pair.wl, pair.wv)[c]} * kScale[c] : -1.0));
        }
  return bytes;
}

TEST_F(Merl, TablesOfOtherProgramsAreTheSameBrdf) {
  constexpr std::array<int32_t, 3> kCounts = {60, 40, 45};
  const auto table = read(table_of<double>(kCounts, false));
  double error = 0, total = 0;
  for (const auto& [wl, wv] : test::random_pairs(3000, 5, 0.1f)) {
    const Rgb truth = test::glossy(wl, wv), d = test::eval_one(*table, wl, wv).f - truth;
    error += double{glm::dot(d, d)};
    total += double{glm::dot(truth, truth)};
  }
  EXPECT_LT(std::sqrt(error / total), 4e-3);
  const std::pair<const char*, std::vector<uint8_t>> kOthers[] = {
      {"big-endian", table_of<double>(kCounts, true)},
      {"float32", table_of<float>(kCounts, false)},
      {"big-endian float32", table_of<float>(kCounts, true)}};
  for (const auto& [name, bytes] : kOthers) {
    EXPECT_TRUE(looks_like_merl(std::span(bytes).first(12))) << name;
    const auto other = read(bytes);
    for (const auto& [wl, wv] : test::random_pairs(300, 6)) {
      const Rgb expected = test::eval_one(*table, wl, wv).f;
      EXPECT_LE(glm::length(test::eval_one(*other, wl, wv).f - expected), 1e-6f * glm::length(expected)) << name;
    }
  }
  test::record_input("MERL .binary", "other numbers of nodes, float32, big-endian", "read");
}

TEST_F(Merl, AWholeTurnIsNotGuessed) {
  const auto bytes = table_of<float>({4, 4, 360}, false);
  EXPECT_NE(test::refusal([&] { read(bytes); }).find("phi_diff is 360"), std::string::npos);
  test::record_input("MERL .binary", "more than 180 nodes of phi_diff", "refused: half a turn or a whole one");
}

TEST_F(Merl, WriterRefusesAWrongSize) {
  EXPECT_NE(test::refusal([&] { write_merl(path_ + ".bad", std::vector<double>(7)); }), "");
}

}  // namespace
}  // namespace velour::merl_test
