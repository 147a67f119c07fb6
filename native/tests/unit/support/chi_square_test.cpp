// The harness that judges every sampler is itself judged here: it must accept what is right and reject what is not.
#include "support/chi_square.h"

#include <gtest/gtest.h>

#include "math/sphere/frame.h"
#include "math/sphere/warp.h"
#include "math/srbf/kernel.h"
#include "support/artifacts_fixture.h"
#include "support/statistics.h"

namespace velour::test {
namespace {

ChiSquareOptions options(int64_t samples = 200'000) {
  ChiSquareOptions o;
  o.samples = samples;
  return o;
}

Vec3 sample_lobe(const Vec3& center, double bandwidth, const Vec2& u) {
  const auto d = static_cast<float>(kernel_sample(Kernel::gaussian, bandwidth, u.x));
  const float sine = std::sqrt(d * (2 - d)), phi = 2 * kPi * u.y;
  return Frame::about(center).to_world({sine * std::cos(phi), sine * std::sin(phi), 1 - d});
}

double pdf_lobe(const Vec3& center, double bandwidth, const Vec3& w) {
  return kernel_value(Kernel::gaussian, bandwidth, one_minus_dot(Vec3d(w), Vec3d(center))) /
         kernel_integral(Kernel::gaussian, bandwidth);
}

TEST(ChiSquare, AcceptsCorrectSamplers) {
  const auto uniform = chi_square(
      sample_uniform_sphere, [](const Vec3&) { return 0.25 / kPiD; }, options());
  EXPECT_EQ(uniform.problem, "");
  EXPECT_GT(uniform.p_value, 0.001);
  EXPECT_NEAR(uniform.density_mass, 1, 1e-9);
  const auto cosine = chi_square(sample_cosine_hemisphere, pdf_cosine_hemisphere, options());
  EXPECT_EQ(cosine.problem, "");
  EXPECT_GT(cosine.p_value, 0.001);
  EXPECT_NEAR(cosine.density_mass, 1, 1e-4);
}

TEST(ChiSquare, ResolvesASharpLobeAboutItsAxis) {
  ChiSquareOptions o = options();
  o.axis = glm::normalize(Vec3(1, -2, 0.3f));
  o.concentration = 1e6;
  const auto result = chi_square([&](const Vec2& u) { return sample_lobe(o.axis, 1e6, u); },
                                 [&](const Vec3& w) { return pdf_lobe(o.axis, 1e6, w); }, o);
  EXPECT_EQ(result.problem, "");
  EXPECT_GT(result.p_value, 0.001);
  EXPECT_NEAR(result.density_mass, 1, 1e-5);
  EXPECT_GT(result.degrees_of_freedom, 300);
}

ChiSquareResult judge_lobe(double bandwidth, double claimed, const ChiSquareOptions& o) {
  return chi_square([&](const Vec2& u) { return sample_lobe(o.axis, bandwidth, u); },
                    [&](const Vec3& w) { return pdf_lobe(o.axis, claimed, w); }, o);
}

TEST(ChiSquare, RejectsABandwidthOffByFivePercent) {
  for (const double bandwidth : {3.0, 200.0, 1e6}) {
    ChiSquareOptions o = options();
    o.concentration = bandwidth;
    const auto result = judge_lobe(bandwidth, 1.05 * bandwidth, o);
    EXPECT_EQ(result.problem, "");
    EXPECT_LT(result.p_value, 1e-6) << bandwidth;
  }
}

// What smallest_bandwidth_error promises: 99 of 100 seeds at that error, half of them at about half of it.
TEST(ChiSquare, HasThePowerThatItsFormulaStates) {
  ChiSquareOptions o = options(50'000);
  o.rows = 15;
  o.columns = 8;
  o.concentration = 200;
  const double level = sidak_level(0.01, 100);
  int rejected = 0;
  for (o.seed = 1; o.seed <= 100; ++o.seed) {
    const ChiSquareResult right = judge_lobe(200, 200, o);
    const double error = smallest_bandwidth_error(o.samples, right.degrees_of_freedom + 1, level);
    rejected += judge_lobe(200, 200 * (1 + error), o).p_value < level;
    EXPECT_GT(right.p_value, level) << o.seed;
  }
  EXPECT_GE(rejected, 95);
}

TEST(ChiSquare, ReportsMassOtherThanOne) {
  const auto half = chi_square(
      sample_uniform_hemisphere, [](const Vec3& w) { return w.z > 0 ? 0.25 / kPiD : 0; }, options(50'000));
  EXPECT_NEAR(half.density_mass, 0.5, 1e-3);
  EXPECT_LT(half.p_value, 1e-6);
  const auto twice = chi_square(
      sample_uniform_sphere, [](const Vec3&) { return 0.5 / kPiD; }, options(50'000));
  EXPECT_NE(twice.problem, "");
}

TEST(ChiSquare, NamesBrokenDensitiesAndSamples) {
  const ChiSquareOptions o = options(10'000);
  const auto fair = [](const Vec3&) { return 0.25 / kPiD; };
  EXPECT_NE(chi_square(
                sample_uniform_sphere, [](const Vec3& w) { return double(w.z); }, o)
                .problem,
            "");
  EXPECT_NE(chi_square(
                sample_uniform_sphere, [](const Vec3&) { return std::nan(""); }, o)
                .problem,
            "");
  EXPECT_NE(chi_square([](const Vec2&) { return Vec3(0, 0, 2); }, fair, o).problem, "");
  EXPECT_NE(chi_square([](const Vec2&) { return Vec3(std::nanf("")); }, fair, o).problem, "");
  EXPECT_NE(chi_square(sample_uniform_sphere, pdf_uniform_hemisphere, o).problem, "");
}

// Over many seeds the p-values of a correct sampler are uniform: their mean is 1/2.
TEST(ChiSquare, PValuesAreUniformForACorrectSampler) {
  RunningMean mean;
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    ChiSquareOptions o = options(20'000);
    o.rows = 11;
    o.columns = 8;
    o.seed = seed;
    mean.add(chi_square(sample_cosine_hemisphere, pdf_cosine_hemisphere, o).p_value);
  }
  EXPECT_GT(z_test({mean.mean(), std::sqrt(1 / 12.0 / 60)}, {0.5}), 0.001);
  EXPECT_NEAR(mean.variance(), 1 / 12.0, 0.04);
}

class ChiSquareEvidence : public ArtifactsFixture {};

TEST_F(ChiSquareEvidence, IsWrittenByAFailureAndNamed) {
  ChiSquareOptions o = options(20'000);
  o.concentration = 200;
  const auto verdict = follows_density(judge_lobe(200, 300, o), 0.01, "a lobe / of 200");
  ASSERT_FALSE(verdict);
  const auto path = only_file();
  EXPECT_NE(std::string(verdict.message()).find(path.string()), std::string::npos);
  EXPECT_EQ(path.filename(), "ChiSquareEvidence.IsWrittenByAFailureAndNamed.a_lobe___of_200.cells.csv");
  const auto lines = lines_of(path);
  ASSERT_EQ(lines.size(), 1 + 51u * 40u);
  EXPECT_EQ(lines[0], "d0,d1,phi0,phi1,observed,expected,normalized_difference");
}

TEST_F(ChiSquareEvidence, IsNotWrittenBySuccess) {
  ChiSquareOptions o = options(20'000);
  o.concentration = 200;
  EXPECT_TRUE(follows_density(judge_lobe(200, 200, o), 0.01, "a lobe"));
  EXPECT_TRUE(files().empty());
}

TEST_F(ChiSquareEvidence, AProblemOrAMissingMassIsAFailure) {
  const auto fair = [](const Vec3&) { return 0.25 / kPiD; };
  ChiSquareResult result = chi_square(sample_uniform_sphere, fair, options(20'000));
  EXPECT_TRUE(follows_density(result, 0.01, "uniform"));
  result.density_mass = 0.99;
  EXPECT_FALSE(follows_density(result, 0.01, "uniform"));
  result.density_mass = 1;
  result.problem = "invented";
  const auto verdict = follows_density(result, 0.01, "uniform");
  EXPECT_FALSE(verdict);
  EXPECT_NE(std::string(verdict.message()).find("invented"), std::string::npos);
}

}  // namespace
}  // namespace velour::test
