// Damaged files of every format, by the thousand: each is read or refused with a sentence, and nothing else happens.
// The seed is fixed; run it under the sanitize preset to see reads outside the file.
#include <gtest/gtest.h>

#include <cmath>

#include "base/file.h"
#include "brdf/formats/cornell.h"
#include "brdf/formats/merl.h"
#include "brdf/formats/rgl.h"
#include "brdf/measure/brdf_table.h"
#include "measurement_support.h"
#include "support/mutation.h"
#include "support/test_data.h"

namespace velour::hostile_test {
namespace {

using Bytes = std::vector<uint8_t>;
using Read = std::shared_ptr<const Measurement> (*)(std::span<const uint8_t>, Provenance);

void expect_sane(const Measurement& measurement) {
  const EntryCounts& counts = measurement.counts();
  EXPECT_EQ(counts.total, counts.valid + counts.invalid() + counts.below_horizon);
  for (const auto& [wl, wv] : test::random_pairs(8, 21)) {
    const auto [f, valid] = test::eval_one(measurement, wl, wv);
    EXPECT_TRUE(std::isfinite(f.r) && std::isfinite(f.g) && std::isfinite(f.b));
    EXPECT_TRUE(valid || f == Rgb(0.0f));
  }
}

void attack(const char* name, const Bytes& good, Read read, uint64_t trials) {
  ASSERT_EQ(test::refusal([&] { expect_sane(*read(good, test::provenance_named(name))); }), "");
  int refused = 0, accepted = 0;
  for (uint64_t trial = 0; trial < trials; ++trial) {
    RandomStream random(99, 0, trial);
    Bytes bytes = good;
    for (uint64_t changes = 1 + random.next_bits() % 4; changes > 0; --changes) test::mutate(bytes, random);
    try {
      expect_sane(*read(bytes, test::provenance_named(name)));
      ++accepted;
    } catch (const Error& error) {
      ++refused;
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  }
  ::testing::Test::RecordProperty("refused", refused);
  ::testing::Test::RecordProperty("accepted", accepted);
  EXPECT_GT(refused, 20);
}

TEST(Hostile, Rgl) {
  const auto color = [](size_t, size_t t, size_t, size_t x) { return Rgb(static_cast<float>(t + x)); };
  attack("x.bsdf", test::small_rgl({-kPi, -1.5f, 0.0f}, color).bytes(), read_rgl, 400);
}

TEST(Hostile, Cornell) {
  const std::string text =
      test::small_cornell(20, [](const Vec3& wl, const Vec3& wv) { return test::glossy(wl, wv).g; });
  const auto read = [](std::span<const uint8_t> bytes, Provenance provenance) {
    return read_cornell(bytes, std::move(provenance), Progress());
  };
  attack("x.brdf", Bytes(text.begin(), text.end()), read, 200);
}

TEST(Hostile, BrdfTable) {
  const std::string path = test::scratch_folder() / "a.exr";
  const BrdfTableLayout layout{.theta_h = 5, .phi_h = 4, .theta_d = 3, .phi_d = 4};
  write_brdf_table(path, {layout, std::vector<Rgb>(layout.size(), Rgb(0.5f)), "flat"});
  attack("x.exr", read_file(path), read_brdf_table, 2000);
}

TEST(Hostile, MerlHeader) {
  Bytes head(4096);
  head[0] = head[4] = 90;
  head[8] = 180;
  for (uint64_t trial = 0; trial < 2000; ++trial) {
    RandomStream random(98, 0, trial);
    Bytes bytes = head;
    test::mutate(bytes, random);
    EXPECT_NE(test::refusal([&] { read_merl(bytes, test::provenance_named("x.binary")); }), "");
  }
}

}  // namespace
}  // namespace velour::hostile_test
