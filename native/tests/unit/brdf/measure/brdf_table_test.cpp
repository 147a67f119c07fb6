#include "brdf/measure/brdf_table.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/file.h"
#include "image/tensors/exr_tensors.h"
#include "measurement_support.h"
#include "support/test_data.h"

namespace velour::brdf_table_test {
namespace {

/// A stretched highlight, the same after half a turn.
Rgb brushed(const Vec3& wl, const Vec3& wv) {
  const Vec3 h = glm::normalize(wl + wv);
  const float slope_x = h.x / h.z / 0.3f, slope_y = h.y / h.z / 0.1f;
  return Rgb(0.1f) + Rgb(4.0f, 3.0f, 2.0f) * std::exp(-slope_x * slope_x - slope_y * slope_y);
}

BrdfTable tabulate(const BrdfTableLayout& layout) {
  BrdfTable table{layout, std::vector<Rgb>(layout.size(), Rgb(NAN)), "brushed"};
  for (int i = 0; i < layout.theta_h; ++i)
    for (int j = 0; j < layout.phi_h; ++j)
      for (int k = 0; k < layout.theta_d; ++k)
        for (int l = 0; l < layout.phi_d; ++l) {
          const DirectionPair pair = layout.pair(i, j, k, l);
          if (pair.wl.z > 0 && pair.wv.z > 0) table.f[layout.index(i, j, k, l)] = brushed(pair.wl, pair.wv);
        }
  return table;
}

const BrdfTableLayout kLayout{.theta_h = 40, .phi_h = 36, .theta_d = 12, .phi_d = 12, .folds = 2};

std::shared_ptr<const Measurement> read(const TensorFile& file) {
  return read_brdf_table(encode_tensors(file), test::provenance_named("bad.velour"));
}

TensorFile decoded_table(const std::string& path) {
  write_brdf_table(path, tabulate({.theta_h = 4, .phi_h = 3, .theta_d = 3, .phi_d = 4}));
  return decode_tensors(read_file(path), path);
}

TEST(BrdfTable, RoundTripOfAStretchedHighlight) {
  const std::string path = test::scratch_folder() / "brushed.exr";
  write_brdf_table(path, tabulate(kLayout));
  const auto measurement = load_measurement(path);
  EXPECT_EQ(measurement->provenance().format, "velour-table");
  EXPECT_EQ(measurement->provenance().description, "brushed");
  EXPECT_FALSE(measurement->isotropic());
  EXPECT_EQ(measurement->counts().invalid(), 0u);
  double error = 0, total = 0;
  for (const auto& [wl, wv] : test::random_pairs(20000, 8, 0.1f)) {
    const auto [f, valid] = test::eval_one(*measurement, wl, wv);
    ASSERT_TRUE(valid);
    error += std::pow(double{f.g} - double{brushed(wl, wv).g}, 2);
    total += std::pow(double{brushed(wl, wv).g}, 2);
  }
  EXPECT_LT(std::sqrt(error / total), 0.02);
}

TEST(BrdfTable, AzimuthMattersAndHalfATurnDoesNot) {
  const std::string path = test::scratch_folder() / "brushed.exr";
  write_brdf_table(path, tabulate(kLayout));
  const auto measurement = load_measurement(path);
  float most = 0;
  for (const auto& [wl, wv] : test::random_pairs(2000, 9)) {
    const Rgb f = test::eval_one(*measurement, wl, wv).f;
    const Rgb half_turn = test::eval_one(*measurement, test::rotated(wl, kPi), test::rotated(wv, kPi)).f;
    const Rgb quarter = test::eval_one(*measurement, test::rotated(wl, kPi / 2), test::rotated(wv, kPi / 2)).f;
    EXPECT_LT(glm::length(f - half_turn), 1e-3f * (0.1f + glm::length(f)));
    most = std::max(most, glm::length(f - quarter));
  }
  EXPECT_GT(most, 1.0f);
}

TEST(BrdfTable, SameTableSameBytes) {
  const auto folder = test::scratch_folder();
  write_brdf_table(folder / "a", tabulate(kLayout));
  write_brdf_table(folder / "b", tabulate(kLayout));
  EXPECT_EQ(read_file(folder / "a"), read_file(folder / "b"));
}

TEST(BrdfTable, CountsWhatIsWrongWithItsNodes) {
  const std::string path = test::scratch_folder() / "a";
  BrdfTable table = tabulate(kLayout);
  table.f[kLayout.index(2, 0, 1, 0)] = Rgb(NAN);
  table.f[kLayout.index(3, 0, 1, 0)] = Rgb(-1.0f);
  table.f[kLayout.index(4, 0, 1, 0)] = Rgb(1.0f, 1.0f, -0.5f);
  write_brdf_table(path, table);
  const auto counts = load_measurement(path)->counts();
  EXPECT_EQ(counts.not_finite, 1u);
  EXPECT_EQ(counts.negative, 1u);
  EXPECT_EQ(counts.out_of_gamut, 1u);
  EXPECT_EQ(counts.total, counts.valid + counts.invalid() + counts.below_horizon);
}

TEST(BrdfTable, RefusesLies) {
  const TensorFile good = decoded_table(test::scratch_folder() / "a");
  EXPECT_EQ(test::refusal([&] { read(good); }), "");
  for (const auto& [key, value] : {std::pair{"velour.kind", "scattered"},
                                   {"velour.format_version", "99"},
                                   {"velour.folds", "0"},
                                   {"velour.folds", "1e99"},
                                   {"velour.theta_h_power", "nan"},
                                   {"velour.theta_h_power", "two"}}) {
    TensorFile bad = good;
    bad.attributes[key] = value;
    EXPECT_NE(test::refusal([&] { read(bad); }).find(key), std::string::npos) << key << value;
    bad.attributes.erase(key);
    EXPECT_NE(test::refusal([&] { read(bad); }).find(key), std::string::npos) << key;
  }
  TensorFile bad = good;
  bad.tensors.at("f").shape = {4, 9, 4, 3};
  EXPECT_NE(test::refusal([&] { read(bad); }).find("tensor f"), std::string::npos);
  bad.tensors.clear();
  bad.tensors["g"] = good.tensors.at("f");
  EXPECT_NE(test::refusal([&] { read(bad); }).find("tensor f is missing"), std::string::npos);
}

TEST(BrdfTable, WriterRefusesAWrongSize) {
  const std::string path = test::scratch_folder() / "a";
  EXPECT_NE(test::refusal([&] { write_brdf_table(path, {kLayout, std::vector<Rgb>(3), ""}); }), "");
}

}  // namespace
}  // namespace velour::brdf_table_test
