// What the plain method does where ours holds (docs/results/failure_modes.md): each test shows the usual formula or fit
// failing on a hostile case beside ours.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <limits>

#include "brdf/eval/per_view_material.h"
#include "brdf/fit/error/compare.h"
#include "brdf/fit/fit_report.h"
#include "brdf/fit/peer.h"
#include "brdf/fit/per_view/per_view_fit.h"
#include "brdf/fit/per_view/slice_fit.h"
#include "brdf/measure/brdf_table.h"
#include "math/optimize/nnls.h"
#include "math/sphere/directions.h"
#include "math/sphere/frame.h"
#include "support/hostile_measurements.h"
#include "support/materials.h"

namespace velour::plain_methods_test {
namespace {

using test::AnalyticMeasurement;

Vec3 view_at(float degrees) { return direction(radians_from(degrees), 0); }

/// Error of the model `found` on `lights`.
double error_on(const WeightedLights& lights, const Vec3& wv, const AnalyticMeasurement::Formula& truth,
                const AnalyticMeasurement::Formula& found) {
  ViewError error;
  for (size_t i = 0; i < lights.wl.size(); ++i) {
    const DirectionPair pair{lights.wl[i], wv};
    error.add(lights.weight[i], truth(pair), found(pair), pair.wl.z);
  }
  return error.relative_l2();
}

WeightedLights even_lights() { return {hemisphere_fibonacci(4096), std::vector<double>(4096, 2 * kPiD / 4096)}; }

TEST(PlainMethod, EvenDirectionsTakeAMirrorWithoutItsHighlightForExact) {
  const auto base_alone = [](const DirectionPair&) { return Rgb(0.02f / kPi); };
  const Vec3 wv = view_at(60);
  EXPECT_LT(error_on(even_lights(), wv, test::near_mirror(1e6), base_alone), 1e-3);
  const AnalyticMeasurement mirror(test::near_mirror(1e6));
  const DirectionTree tree(reader_of(mirror, wv), wv, 256);
  WeightedLights lights;
  for (const uint32_t leaf : tree.leaves()) {
    lights.wl.push_back(tree.cell(leaf).wl);
    lights.weight.push_back(tree.cell(leaf).solid_angle());
  }
  EXPECT_GT(error_on(lights, wv, test::near_mirror(1e6), base_alone), 0.99);
}

TEST(PlainMethod, OneMinusADotProductLosesASharpLobe) {
  constexpr double kBandwidth = 1e7;
  double worst = 0, worst_of_ours = 0;
  for (int i = 1; i < 20; ++i) {
    const float angle = 3e-5f * static_cast<float>(i);
    const Vec3 a = direction(0.7f, 0.3f), b = direction(0.7f + angle, 0.3f);
    const double d =
        2 * std::pow(std::sin(0.5 * std::acos(glm::dot(glm::normalize(Vec3d(a)), glm::normalize(Vec3d(b))))), 2);
    const double expected = kernel_value(Kernel::gaussian, kBandwidth, d);
    worst = std::max(worst, std::abs(std::exp(-kBandwidth * static_cast<double>(1 - glm::dot(a, b))) - expected));
    const double ours = kernel_value(Kernel::gaussian, kBandwidth, one_minus_dot(Vec3d(a), Vec3d(b)));
    worst_of_ours = std::max(worst_of_ours, std::abs(ours - expected));
  }
  EXPECT_GT(worst, 0.1);
  EXPECT_LT(worst_of_ours, 0.01);
}

/// Weighted samples of f cos of a Lambertian surface.
std::vector<SliceSample> lambertian_slice() {
  std::vector<SliceSample> samples;
  for (const Vec3& w : hemisphere_fibonacci(2000)) samples.push_back({w, 2 * kPi / 2000, Rgb(w.z)});
  return samples;
}

TEST(PlainMethod, LobesAloneArePoorAtAClippedCosine) {
  const SliceSamples slice(lambertian_slice());
  const auto n = static_cast<Eigen::Index>(slice.count());
  const auto centers = hemisphere_fibonacci(16);
  Eigen::MatrixXd columns(n, 16);
  Eigen::VectorXd target(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto at = static_cast<size_t>(i);
    target[i] = slice.target(1)[at];
    for (Eigen::Index j = 0; j < 16; ++j) {
      const double d = one_minus_dot(slice.wl(at), Vec3d(centers[static_cast<size_t>(j)]));
      columns(i, j) = slice.sqrt_weight()[at] * kernel_value(Kernel::gaussian, 4, d);
    }
  }
  Eigen::VectorXd x;
  solve_nnls(columns.transpose() * columns, columns.transpose() * target, 1e-7, x);
  EXPECT_GT((target - columns * x).norm() / target.norm(), 0.02);
  const Progress progress;
  EXPECT_LT(SliceSolver(Kernel::gaussian, slice, progress).relative_l2(), 1e-6);
}

TEST(PlainMethod, AnErrorRelativeToBlackIsNoNumber) {
  const double nothing = 0;
  EXPECT_TRUE(std::isnan(std::sqrt(nothing / nothing)));
  ViewError black;
  black.add(1, Rgb(0), Rgb(0), 1);
  EXPECT_EQ(black.relative_l2(), 0);
  black.add(1, Rgb(0), Rgb(0.1f), 1);
  EXPECT_EQ(black.relative_l2(), 1);
}

TEST(PlainMethod, ALobeOnOneSampleIsExactThereAndNowhereElse) {
  // A peak of 1 about one of 2000 samples, 2 degrees wide in truth.
  const Vec3d center(hemisphere_fibonacci(2000)[700]);
  const auto bump = [&](double bandwidth, const Vec3d& w) {
    return kernel_value(Kernel::gaussian, bandwidth, one_minus_dot(w, center));
  };
  EXPECT_EQ(bump(1e9, center), 1.0) << "exact at the sample";
  const double integral = kernel_integral(Kernel::gaussian, 1e9),
               true_integral = kernel_integral(Kernel::gaussian, 1500);
  EXPECT_LT(integral, 1e-5 * true_integral);
  const SliceSamples slice(lambertian_slice());
  const Progress progress;
  const double sharpest = SliceSolver(Kernel::gaussian, slice, progress).max_sharpness(center);
  EXPECT_GT(kernel_integral(Kernel::gaussian, sharpest), 0.2 * 2 * kPiD / 2000) << "ours fills the sample's cell";
}

TEST(PlainMethod, OneMicrofacetLobeHasNoRetroReflection) {
  Progress progress;
  EXPECT_GT(judge_peer(AnalyticMeasurement(test::retro_reflector(1000)), Peer::ggx, 0, progress).error.relative_l2,
            0.9);
}

TEST(PlainMethod, SlicesTurnedWithTheMirrorDirectionMoveARetroLobeAway) {
  const Vec3 from = view_at(40), to = view_at(44);
  const Vec3 turned = rotation_between(test::mirror(from), test::mirror(to)) * from;
  EXPECT_NEAR(std::acos(glm::dot(turned, to)) * 180 / kPi, 8, 0.01) << "twice as far as without the turn";
}

TEST(PlainMethod, DividingByTheCosineAtTheHorizonIsInfinite) {
  const float at_horizon = 0;
  EXPECT_TRUE(std::isinf(0.1f / at_horizon));
  EXPECT_GT(1 / std::cos(radians_from(89.9)), 570) << "what lobes of f in place of f cos would have to follow";
  const auto model = std::make_shared<const PerViewBrdf>(test::isotropic_model());
  const auto material = make_per_view_material(model, 0);
  for (const float z : {1e-3f, 1e-10f, 1e-30f, 0.0f, -0.1f}) {
    const auto [f, pdf] = test::eval_one(*material, {{std::sqrt(1 - z * z), 0, z}, view_at(89.9f)});
    EXPECT_TRUE(std::isfinite(f.r * z) && std::isfinite(f.r) && std::isfinite(pdf)) << z;
  }
}

TEST(PlainMethod, TheHalfVectorOfOpposedDirectionsIsNoNumber) {
  const Vec3 wv = view_at(60);
  EXPECT_TRUE(std::isnan(glm::normalize(wv - wv).x));
  const HalfDiff angles = half_diff(-wv, wv);
  EXPECT_TRUE(std::isfinite(angles.theta_h + angles.phi_h + angles.theta_d + angles.phi_d));
  const auto material = make_per_view_material(std::make_shared<const PerViewBrdf>(test::isotropic_model()), 0);
  EXPECT_EQ(test::eval_one(*material, {-wv, wv}).f, Rgb(0));
}

TEST(PlainMethod, NormalEquationsOfTwoEqualLobesAreSingular) {
  Eigen::Matrix2d gram;
  gram << 3, 3, 3, 3;
  const Eigen::Vector2d moment(6, 6);
  EXPECT_FALSE((gram.inverse() * moment).allFinite());
  // A last bit of rounding is enough for coefficients of either sign that cancel.
  gram(0, 0) += 1e-15;
  const Eigen::Vector2d rounded = gram.inverse() * Eigen::Vector2d(6, 6.000001);
  EXPECT_GT(rounded.cwiseAbs().maxCoeff(), 1e6);
  Eigen::VectorXd x;
  solve_nnls(Eigen::Matrix2d::Constant(3), moment, 1e-7, x);
  EXPECT_NEAR(x.sum(), 2, 1e-6);

  const SliceSamples slice(lambertian_slice());
  const Progress progress;
  SliceSolver solver(Kernel::gaussian, slice, progress);
  solver.set_lobes({{{0, 0, 1}, 5}, {{0, 0, 1}, 5}});
  solver.refine(20, 0, 0);
  for (const SliceLobe& lobe : solver.lobes()) EXPECT_TRUE(std::isfinite(lobe.peak.x + lobe.shape.sharpness));
  EXPECT_LT(solver.relative_l2(), 1e-5);
}

TEST(PlainMethod, OpposedLobesHaveNoMeanDirection) {
  const Vec3d a = glm::normalize(Vec3d(1, 2, 3));
  EXPECT_TRUE(std::isnan(glm::normalize(5.0 * a + 5.0 * -a).x));
  const GaussianProduct product = gaussian_product(a, 5, -a, 5);
  EXPECT_NEAR(glm::length(product.center), 1, 1e-12);
  EXPECT_EQ(product.bandwidth, 0);
  EXPECT_NEAR(product.scale, std::exp(-10.0), 1e-12);
  const Mat3 turn = rotation_between(Vec3(a), -Vec3(a));
  EXPECT_NEAR(glm::dot(turn * Vec3(a), -Vec3(a)), 1, 1e-5);
}

TEST(PlainMethod, TheIntegralOfAFlatLobeIsLostToRounding) {
  const auto plain = [](double l) { return 2 * kPiD * (1 - std::exp(-2 * l)) / l; };
  EXPECT_TRUE(std::isnan(plain(0)));
  EXPECT_EQ(plain(1e-17), 0);
  for (const double l : {0.0, 1e-300, 1e-17, 1e-9}) EXPECT_NEAR(kernel_integral(Kernel::gaussian, l), 4 * kPiD, 1e-7);
}

TEST(PlainMethod, LobesWithoutMassHaveNoProbabilities) {
  const float nothing = 0, denormal = 1e-42f;
  EXPECT_TRUE(std::isnan(nothing / nothing));
  EXPECT_TRUE(std::isinf(1 / denormal));
  for (const float coefficient : {0.0f, denormal, 1e-38f, 1e-30f}) {
    LobeMixture mixture;
    mixture.clear(Kernel::gaussian);
    mixture.add({0, 0, 1}, 50, Rgb(coefficient));
    mixture.add({1, 0, 0}, 2, Rgb(coefficient));
    mixture.finish(0.05f);
    for (int j = 0; j < mixture.count; ++j) EXPECT_TRUE(std::isfinite(mixture.density[j])) << coefficient;
    EXPECT_GE(mixture.cosine_share, 0.05f);
  }
}

struct PlainAndOurs {
  FitRecord plain, ours;
};

/// Records of fits of the hostile case `name`, with 0 where nothing was measured and as it is.
PlainAndOurs holes_as_black_and_as_holes(const std::string& name) {
  const auto cases = test::hostile_cases();
  const auto hostile = std::find_if(cases.begin(), cases.end(), [&](const auto& c) { return c.name == name; });
  const AnalyticMeasurement black([given = hostile->given](const DirectionPair& p) {
    Rgb f;
    uint8_t valid = 0;
    given->eval(p.wv, {&p.wl, 1}, {&f, 1}, {&valid, 1});
    return f;
  });
  FitOptions options;
  options.max_lobes = 4;
  Progress progress;
  return {fit_per_view(black, options, progress).fit, fit_per_view(*hostile->given, options, progress).fit};
}

TEST(PlainMethod, HolesTakenForBlackAreFittedAsBlack) {
  const auto [plain, ours] = holes_as_black_and_as_holes("holes at grazing angles");
  EXPECT_EQ(plain.by_view_angle.at("85"), 0.0) << "a black model of a hole is called exact";
  EXPECT_EQ(ours.by_view_angle.at("85"), std::nullopt);
}

TEST(PlainMethod, InvalidEntriesTakenForBlackDarkenTheMaterial) {
  const auto [plain, ours] = holes_as_black_and_as_holes("a third of entries invalid");
  EXPECT_NEAR(*plain.albedo_by_view_angle.at("30") / *ours.albedo_by_view_angle.at("30"), 2.0 / 3, 0.05);
}

TEST(PlainMethod, ARelativeErrorIsBlindToTheScale) {
  FitOptions options;
  options.max_lobes = 3;
  Progress progress;
  const auto error_at = [&](float scale) {
    const AnalyticMeasurement measurement(test::scaled(test::ggx(0.3f, 0.3f), scale));
    return fit_per_view(measurement, options, progress).fit.relative_l2;
  };
  EXPECT_NEAR(error_at(1500), error_at(1), 1e-4);
}

TEST(PlainMethod, NoiseIsNoErrorOfTheFit) {
  const AnalyticMeasurement noisy(test::noisy(test::ggx(0.3f, 0.3f), 0.3));
  const Progress progress;
  EXPECT_NEAR(noise_of_view(noisy, 30, progress).value(), 0.3, 0.03) << "the fit's 0.29 is the measurement's own";
}

TEST(PlainMethod, LeastSquaresFollowColorsOutsideTheGamutWithNegativeLobes) {
  const Eigen::MatrixXd gram = Eigen::MatrixXd::Identity(1, 1);
  const Eigen::VectorXd moment = Eigen::VectorXd::Constant(1, -0.3);
  EXPECT_LT(gram.ldlt().solve(moment)[0], 0);
  Eigen::VectorXd x;
  solve_nnls(gram, moment, 1e-7, x);
  EXPECT_EQ(x[0], 0);
}

TEST(PlainMethod, LightGrowsFromBounceToBounceOnAnAlbedoAboveOne) {
  const auto cases = test::hostile_cases();
  const auto bright =
      std::find_if(cases.begin(), cases.end(), [](const auto& c) { return c.name == "albedo above 1"; });
  FitOptions options;
  options.max_lobes = 3;
  Progress progress;
  const double albedo = fit_per_view(*bright->given, options, progress).fit.albedo_max;
  EXPECT_GT(std::pow(albedo, 50), 1e6);
}

TEST(PlainMethod, HalfAndDifferenceAnglesCannotTellLightFromView) {
  const Vec3 wl = direction(0.3f, 1), wv = direction(1.2f, 0);
  const HalfDiff there = half_diff(wl, wv), back = half_diff(wv, wl);
  EXPECT_NEAR(there.theta_h, back.theta_h, 1e-5);
  EXPECT_NEAR(there.theta_d, back.theta_d, 1e-5);
  EXPECT_NEAR(there.phi_d, back.phi_d, 1e-4);
}

TEST(PlainMethod, SquaresOfHugeAndDenormalFloatsAreInfiniteOrNothing) {
  EXPECT_TRUE(std::isinf(1e28f * 1e28f));
  EXPECT_EQ(1e-40f * 1e-40f, 0);
  ViewError error;
  error.add(1, Rgb(1e-40f), Rgb(0), 1);
  EXPECT_NEAR(error.relative_l2(), 1, 1e-6) << "nothing of it was fitted, and that is what is said";
}

}  // namespace
}  // namespace velour::plain_methods_test
