// The harness that compares means is itself judged here: it must accept what is equal and reject what is not.
#include "support/statistics.h"

#include "math/sphere/random.h"
#include "math/srbf/kernel.h"
#include "support/artifacts_fixture.h"
#include "support/significance.h"

namespace velour::test {
namespace {

/// Mean of `count` sums of three uniform numbers: expectation 1.5.
RunningMean noisy(uint64_t seed, int count, double scale = 1) {
  RunningMean mean;
  for (int i = 0; i < count; ++i) {
    RandomStream random(seed, 7, static_cast<uint64_t>(i));
    mean.add(scale * (static_cast<double>(random.next()) + static_cast<double>(random.next()) +
                      static_cast<double>(random.next())));
  }
  return mean;
}

TEST(RunningMean, IsTheMeanAndItsError) {
  RunningMean mean;
  for (const double x : {1.0, 2.0, 4.0}) mean.add(x);
  EXPECT_DOUBLE_EQ(mean.mean(), 7 / 3.0);
  EXPECT_DOUBLE_EQ(mean.variance(), 7 / 3.0);
  EXPECT_DOUBLE_EQ(mean.estimate().error, std::sqrt(7 / 9.0));
  EXPECT_EQ(mean.estimate().degrees, 2);
}

TEST(ZTest, AgreesWithTables) {
  EXPECT_NEAR(z_test({1.959963984540054, 1}, {0}), 0.05, 1e-12);
  EXPECT_NEAR(z_test({2.085963447265837, 1, 20}, {0}), 0.05, 1e-12);
  EXPECT_EQ(z_test({1, 0}, {1, 0}), 1);
  EXPECT_EQ(z_test({1, 0}, {1.5, 0}), 0);
  EXPECT_EQ(z_test({std::nan(""), 1}, {1, 1}), 0);
  EXPECT_NEAR(difference({1, 3, 10}, {0, 3, 10}).degrees, 20, 1e-12);  // Welch: equal errors pool
  EXPECT_NEAR(difference({1, 3, 10}, {0, 0}).degrees, 10, 1e-12);
}

// Errors estimated from six values: the p-values stay uniform (Welch's are a little too large), where those of the
// normal distribution would fall below 0.01 three times too often.
TEST(ZTest, PValuesAreUniformForEqualExpectations) {
  RunningMean mean;
  int below = 0;
  constexpr int kTests = 4000;
  for (uint64_t seed = 0; seed < kTests; ++seed) {
    const double p = z_test(noisy(2 * seed, 6).estimate(), noisy(2 * seed + 1, 6).estimate());
    mean.add(p);
    below += p < 0.01;
  }
  EXPECT_NEAR(mean.mean(), 0.5, 0.02);
  EXPECT_NEAR(below, 0.01 * kTests, 4 * std::sqrt(0.01 * kTests));
}

TEST(ZTests, AListHasItsLevelAsAWhole) {
  int rejected = 0;
  constexpr int kLists = 400;
  for (uint64_t list = 0; list < kLists; ++list) {
    ZTests tests;
    for (uint64_t i = 0; i < 10; ++i) {
      tests.add(std::to_string(i), noisy(1000 + list * 20 + i, 10).estimate(),
                noisy(500'000 + list * 20 + i, 10).estimate());
    }
    EXPECT_EQ(tests.level_of_each(), sidak_level(0.01, 10));
    rejected += !tests.agree();
  }
  EXPECT_LE(rejected, 12);  // 4 expected; more than 12 in one of two thousand
}

TEST(ZTests, SmallestBiasIsSeenAsOftenAsStated) {
  int seen = 0;
  constexpr int kTrials = 300;
  for (uint64_t trial = 0; trial < kTrials; ++trial) {
    ZTests right, biased;
    const Estimate expected = noisy(3 * trial, 1000).estimate();
    right.add("mean", noisy(3 * trial + 1, 1000).estimate(), expected);
    const double bias = right.smallest_bias("mean");
    biased.add("mean", noisy(3 * trial + 2, 1000, 1 + bias).estimate(), expected);
    seen += !biased.agree();
  }
  EXPECT_GE(seen, 0.97 * kTrials);
  EXPECT_LT(seen, kTrials);  // a bound that is always met would be no bound
  EXPECT_THROW(ZTests().smallest_bias("none"), std::invalid_argument);
}

/// The estimator of a renderer: the integral of a lobe twice as sharp as the one that directions are drawn from, whose
/// density is claimed; relative to its closed form. (The integral of the lobe itself would hide a wrong bandwidth: the
/// errors of peak and width cancel to second order.)
RunningMean relative_integral(double bandwidth, double claimed) {
  RunningMean mean;
  const double exact = kernel_integral(Kernel::gaussian, 2 * bandwidth);
  for (uint64_t i = 0; i < 100'000; ++i) {
    const double u = static_cast<double>(RandomStream(5, 5, i).next());
    const double d = kernel_sample(Kernel::gaussian, bandwidth, u);
    const double density = kernel_value(Kernel::gaussian, claimed, d) / kernel_integral(Kernel::gaussian, claimed);
    mean.add(kernel_value(Kernel::gaussian, 2 * bandwidth, d) / density / exact);
  }
  return mean;
}

TEST(ZTests, RejectsABandwidthOffByFivePercent) {
  for (const double bandwidth : {3.0, 200.0, 1e6}) {
    ZTests right, wrong;
    right.add("lobe", relative_integral(bandwidth, bandwidth).estimate(), {1});
    wrong.add("lobe", relative_integral(bandwidth, 1.05 * bandwidth).estimate(), {1});
    EXPECT_TRUE(right.agree()) << bandwidth;
    EXPECT_FALSE(right.differ()) << bandwidth;
    EXPECT_TRUE(wrong.differ()) << bandwidth;
  }
}

class ZTestsEvidence : public ArtifactsFixture {};

TEST_F(ZTestsEvidence, IsWrittenByAFailureAndNamed) {
  ZTests tests;
  tests.add("good", {1, 0.1}, {1.05, 0.1}, [] { return "never asked for"; });
  tests.add("bad", {1, 0.1}, {2, 0.1}, [] { return "a picture of it"; });
  const auto verdict = tests.agree();
  ASSERT_FALSE(verdict);
  const std::string message = verdict.message();
  EXPECT_NE(message.find("bad: found 1 +- 0.1, expected 2 +- 0.1"), std::string::npos) << message;
  EXPECT_NE(message.find("a picture of it"), std::string::npos);
  EXPECT_EQ(message.find("never asked for"), std::string::npos);
  EXPECT_NE(message.find(only_file().string()), std::string::npos);
  EXPECT_EQ(lines_of(only_file()).size(), 3u);
}

TEST_F(ZTestsEvidence, IsNotWrittenBySuccess) {
  ZTests tests;
  tests.add("good", {1, 0.1}, {1.05, 0.1}, [] { return "never asked for"; });
  EXPECT_TRUE(tests.agree());
  EXPECT_FALSE(tests.differ());
  EXPECT_TRUE(files().empty());
  EXPECT_FALSE(ZTests().agree());  // nothing compared is nothing proven
}

}  // namespace
}  // namespace velour::test
