#include "brdf/formats/cornell.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "brdf/measure/held_out.h"
#include "brdf/measure/irregular_samples.h"
#include "measurement_support.h"
#include "support/inputs.h"
#include "support/test_data.h"

namespace velour::cornell_test {
namespace {

using test::small_cornell;

std::shared_ptr<const Measurement> read(const std::string& text) {
  return read_cornell(std::vector<uint8_t>(text.begin(), text.end()), test::provenance_named("x.brdf"));
}
std::string refusal(const std::string& text) {
  return test::refusal([&] { read(text); });
}
float glossy_gray(const Vec3& wl, const Vec3& wv) { return test::glossy(wl, wv).g; }

double relative_l2(const std::vector<double>& got, const std::vector<double>& truth) {
  double error = 0, total = 0;
  for (size_t i = 0; i < got.size(); ++i) {
    error += (got[i] - truth[i]) * (got[i] - truth[i]);
    total += truth[i] * truth[i];
  }
  return std::sqrt(error / total);
}

TEST(Cornell, ReadsEverySample) {
  const auto measurement = read(small_cornell(300, glossy_gray));
  EXPECT_EQ(measurement->provenance().format, "cornell");
  EXPECT_EQ(measurement->provenance().description, "A test of words");
  EXPECT_TRUE(measurement->isotropic());
  ASSERT_EQ(measurement->samples().size(), 300u);
  EXPECT_EQ(measurement->counts().valid, 300u);
  for (const auto& sample : measurement->samples())
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sample.f[c], glossy_gray(sample.wl, sample.wv), 1e-4f * (1 + sample.f[c]));
}

TEST(Cornell, InterpolatesASmoothBrdf) {
  const auto measurement = read(small_cornell(3000, glossy_gray));
  std::vector<double> got, truth;
  for (const auto& [wl, wv] : test::random_pairs(3000, 11, 0.2f)) {
    const auto [f, valid] = test::eval_one(*measurement, wl, wv);
    if (!valid) continue;
    got.push_back(double{f.g});
    truth.push_back(double{glossy_gray(wl, wv)});
  }
  EXPECT_GT(got.size(), 2900u);
  EXPECT_LT(relative_l2(got, truth), 0.1);
}

TEST(Cornell, HeldOutSamplesAreNotInterpolated) {
  const auto measurement = read(small_cornell(400, glossy_gray));
  const auto unseen = measurement->without_held_out(Progress());
  size_t kept = 0;
  for (size_t i = 0; i < measurement->samples().size(); ++i) kept += !held_out_sample(i);
  ASSERT_EQ(unseen->samples().size(), kept);
  EXPECT_LT(kept, 400u);
  EXPECT_EQ(unseen->provenance().sha256, measurement->provenance().sha256);
  // Somewhere the samples that are gone must be missed.
  float largest = 0;
  for (const auto& sample : measurement->samples()) {
    const auto with = test::eval_one(*measurement, sample.wl, sample.wv);
    const auto without = test::eval_one(*unseen, sample.wl, sample.wv);
    if (with.valid && without.valid) largest = std::max(largest, std::abs(with.f.g - without.f.g));
  }
  EXPECT_GT(largest, 1e-3f);
}

TEST(Cornell, InvalidSamplesAreCountedNotUsed) {
  std::string text = small_cornell(100, glossy_gray);
  text +=
      "0.1 0 0.2 0 nan 1 1\n0.1 0 0.2 0 -1 -1 -1\n1.6 0 0.2 0 1 1 1\nnan 0 0.2 0 1 1 1\n0.1 0 0.2 0 0 1e99 0\n0.3 0 "
      "0.2 0 1 -0.01 1\n";
  const auto measurement = read(text);
  const auto& counts = measurement->counts();
  EXPECT_EQ(counts.total, 106u);
  EXPECT_EQ(counts.not_finite, 3u);
  EXPECT_EQ(counts.negative, 1u);
  EXPECT_EQ(counts.below_horizon, 1u);
  EXPECT_EQ(counts.valid, 101u);
  EXPECT_EQ(measurement->samples().size(), 101u);
}

TEST(Cornell, NumbersMayHaveAPlusSign) {
  test::record_input("Cornell .brdf", "numbers with a plus sign", "read");
  const std::string plain = small_cornell(40, glossy_gray);
  const size_t values = plain.find("700\n") + 4;
  const std::string with_sign = plain.substr(0, values) + "+0.1 +0 +2e-1 0 +0.25 0.25 0.25\n" + plain.substr(values);
  const auto measurement = read(with_sign);
  EXPECT_EQ(measurement->samples().size(), 41u);
  EXPECT_NEAR(measurement->samples()[0].f.g, 0.25, 1e-5);
}

TEST(Cornell, NumbersBeyondADoubleAreCountedOrZero) {
  test::record_input("Cornell .brdf", "values too large or too small for a double", "not finite, counted; 0");
  const auto measurement =
      read(small_cornell(100, glossy_gray) + "0.1 0 0.2 0 1e400 1 1\n0.1 0 0.2 0 -1e400 1 1\n0.1 0 0.2 0 1e-400 1 1\n");
  EXPECT_EQ(measurement->counts().not_finite, 2u);
  EXPECT_EQ(measurement->counts().valid, 101u);
}

TEST(Cornell, WordsAreNamedWithTheirLine) {
  test::record_input("Cornell .brdf", "decimal commas, other words", "refused with the line");
  for (const char* end : {"\n", "\r\n", "\r"}) {
    const std::string text =
        std::string("# two lines") + end + "# of comment" + end + "1 550" + end + "0,5 0 0.1 0 1" + end;
    EXPECT_EQ(refusal(text),
              "x.brdf: line 4 has '0,5' where a number is expected; write numbers as 0.17 or 1.7e-1, separated by "
              "blanks.");
  }
}

TEST(Cornell, FarFromAllSamplesIsNotCovered) {
  std::string text = "1 550\n";
  for (int i = 0; i < 40; ++i)
    text += std::to_string(0.5 + 0.001 * i) + " 0 " + std::to_string(0.5 + 0.002 * i) + " 3.1 0.2\n";
  const auto measurement = read(text);
  EXPECT_TRUE(test::eval_one(*measurement, direction(0.52f, 0), direction(0.53f, 3.1f)).valid);
  EXPECT_FALSE(test::eval_one(*measurement, direction(1.2f, 0), direction(1.2f, 0)).valid);
  EXPECT_FALSE(measurement->covers_view(0.52f));  // one light direction of it is no view
  EXPECT_FALSE(measurement->covers_view(1.3f));
}

TEST(Cornell, RefusesLies) {
  const std::string good = small_cornell(50, glossy_gray);
  EXPECT_NE(refusal("").find("number of wavelengths"), std::string::npos);
  EXPECT_NE(refusal("-1 400").find("number of wavelengths is -1"), std::string::npos);
  EXPECT_NE(refusal("99999999999 400").find("number of wavelengths"), std::string::npos);
  EXPECT_NE(refusal("31 400 410").find("has 2 of 31 wavelengths"), std::string::npos);
  EXPECT_NE(refusal("2 700 400").find("wavelengths has 400"), std::string::npos);
  EXPECT_NE(refusal("1 500 # nothing else").find("0 valid samples"), std::string::npos);
  EXPECT_NE(refusal(good + "0.1 0 0.2").find("sample 51 has 3 of 7 numbers"), std::string::npos);
  EXPECT_NE(refusal(good + "0.1 0 0.2 0 1 x 1").find("'x'"), std::string::npos);
  EXPECT_NE(refusal(good + "45 0 30 0 1 1 1").find("radians"), std::string::npos);
}

TEST(Cornell, TruncationIsSeenUnlessASampleEndsThere) {
  const std::string good = small_cornell(30, glossy_gray);
  const size_t first_row = good.find("700\n") + 4;
  int accepted = 0;
  for (size_t size = 0; size < good.size(); size += 31) {
    const std::string sentence = refusal(good.substr(0, size));
    accepted += sentence.empty();
    EXPECT_TRUE(size >= first_row || !sentence.empty()) << size;
  }
  EXPECT_LT(accepted, 15);  // cuts within the last number of a sample
}

TEST(Cornell, IsToldFromOtherText) {
  const auto looks = [](std::string_view text) { return looks_like_cornell(text); };
  EXPECT_TRUE(looks("# hello\n3 400 550 700"));
  EXPECT_FALSE(looks("v 1 2 3\nf 1 2 3"));
  EXPECT_FALSE(looks("{\"a\": 1}"));
  EXPECT_FALSE(looks("3 4 5 6"));
  EXPECT_FALSE(looks(""));
  EXPECT_FALSE(looks(std::string_view("3 400 \0", 7)));
}

class Krylon : public ::testing::Test {
 protected:
  struct LeftOut {
    double relative_l2, log_rms;  // of f cos, luminance; log(1 + f cos / 0.01)
  };
  /// Every sample predicted from those that are not in its sixteenth.
  static LeftOut left_out(const std::vector<IrregularSample>& samples) {
    constexpr size_t kParts = 16;
    std::vector<double> got, truth;
    double log_error = 0;
    for (size_t part = 0; part < kParts; ++part) {
      std::vector<IrregularSample> others;
      for (size_t i = 0; i < samples.size(); ++i) {
        if (i % kParts != part) others.push_back(samples[i]);
      }
      const IrregularInterpolant interpolant(others);
      for (size_t i = part; i < samples.size(); i += kParts) {
        const auto f = interpolant.f(samples[i].wl, samples[i].wv);
        EXPECT_TRUE(f.has_value());
        got.push_back(double{luminance(f.value_or(Rgb(0.0f))) * samples[i].wv.z});
        truth.push_back(double{luminance(samples[i].f) * samples[i].wv.z});
        log_error += std::pow(std::log1p(got.back() / 0.01) - std::log1p(truth.back() / 0.01), 2);
      }
    }
    return {relative_l2(got, truth), std::sqrt(log_error / static_cast<double>(got.size()))};
  }
};

TEST_F(Krylon, InterpolationPredictsHeldOutSamples) {
  VELOUR_NEED_DATA(path, "brdf/krylon_blue.brdf");
  const auto measurement = load_measurement(path);
  ASSERT_EQ(measurement->samples().size(), 1439u);
  const std::vector<IrregularSample> samples(measurement->samples().begin(), measurement->samples().end());
  const auto [l2, log_rms] = left_out(samples);
  RecordProperty("relative_l2", std::to_string(l2));
  RecordProperty("log_rms", std::to_string(log_rms));
  EXPECT_LT(l2, 0.06);
  EXPECT_LT(log_rms, 0.09);
  // Control: the same samples with their values dealt out anew must not be predictable.
  auto shuffled = samples;
  for (size_t i = 0; i < samples.size(); ++i) shuffled[i].f = samples[(i * 577) % samples.size()].f;
  EXPECT_GT(left_out(shuffled).log_rms, 0.5);
}

TEST_F(Krylon, TheTableAddsLittle) {
  VELOUR_NEED_DATA(path, "brdf/krylon_blue.brdf");
  const auto measurement = load_measurement(path);
  const IrregularInterpolant interpolant(measurement->samples());
  std::vector<double> got, truth;
  for (const auto& [wl, wv] : test::random_pairs(4000, 13, 0.1f)) {
    const auto exact = interpolant.f(wl, wv);
    const auto [f, valid] = test::eval_one(*measurement, wl, wv);
    if (!exact || !valid) continue;
    got.push_back(double{luminance(f) * wl.z});
    truth.push_back(double{luminance(*exact) * wl.z});
  }
  EXPECT_GT(got.size(), 3900u);
  RecordProperty("relative_l2", std::to_string(relative_l2(got, truth)));
  EXPECT_LT(relative_l2(got, truth), 0.03);
}

TEST_F(Krylon, CoversWhatWasMeasured) {
  VELOUR_NEED_DATA(path, "brdf/krylon_blue.brdf");
  const auto measurement = load_measurement(path);
  for (const float degrees : {5.0f, 30.0f, 60.0f, 75.0f}) EXPECT_TRUE(measurement->covers_view(radians_from(degrees)));
  EXPECT_FALSE(measurement->covers_view(radians_from(85.0f)));
}

/// 1e39 is finite, but not as a float.
TEST(Cornell, AnglesBeyondAFloatAreNotFinite) {
  const auto measurement = read(small_cornell(300, glossy_gray) + "0.5 1e39 0.5 0 1 1 1\n");
  EXPECT_EQ(measurement->counts().not_finite, 1u);
  EXPECT_EQ(measurement->counts().valid, 300u);
}

}  // namespace
}  // namespace velour::cornell_test
