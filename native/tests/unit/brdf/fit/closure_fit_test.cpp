#include "brdf/fit/closures/closure_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "brdf/fit/closures/closure_problem.h"
#include "brdf/fit/closures/closure_search.h"
#include "brdf/fit/error/evaluate.h"
#include "closure_examples.h"
#include "material/microfacet/ggx_sampler.h"
#include "math/sphere/directions.h"

namespace velour::closure_fit_test {
namespace {

using test::kBeckmann, test::kCorrelated, test::kGgx, test::kSeparable;
using test::lobe_of, test::network_of, test::source_of;

ClosureFit fit_of(const ClosureSource& source, const ClosureFitOptions& options = {}) {
  Progress progress;
  return fit_closures(source, options, progress);
}

/// Weights, tilt and stretch that vary with the view, within what a spline of the fit represents.
ClosureNetwork varying_network(LobeDistribution of_wide = kGgx) {
  ClosureNetwork network =
      network_of({0.1f, 0.06f, 0.03f}, {lobe_of(kGgx, Rgb(1), 0.1f), lobe_of(of_wide, Rgb(1), 0.35f)});
  for (size_t i = 0; i < kClosureSamples; ++i) {
    const float x = static_cast<float>(i) / (kClosureSamples - 1), grazing = x * x * x * x;
    ClosureLobe &sharp = network.lobes[0], &wide = network.lobes[1];
    sharp.weight[i] = Rgb(0.3f, 0.25f, 0.2f) + 0.3f * grazing;
    wide.weight[i] = Rgb(0.1f, 0.15f, 0.2f) * (1 - 0.3f * grazing);
    sharp.roughness[i] *= 1 - 0.2f * x * x;
    sharp.anisotropy[i] = -0.4f * x * x;
    wide.anisotropy[i] = 0.3f * x * x;
    wide.tilt[i] = 0.2f * x * x * (3 - 2 * x);
  }
  return network;
}

/// A GGX material with a diffuse base: Schlick's Fresnel term and correlated masking, so no network is exact.
ClosureSource ggx_source(const GgxParameters& parameters) {
  return {[material = make_ggx_material(parameters)](const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f) {
            evaluate(*material, wv, wl, f);
          },
          parameters.alpha.x == parameters.alpha.y};
}

std::vector<ClosureView> views_of(const ClosureSource& source) {
  std::vector<ClosureTarget> targets;
  for (const float degrees : {2.0f, 20.0f, 40.0f, 60.0f, 80.0f}) {
    targets.push_back(closure_target(source, highlight_widths(source), radians_from(degrees), 200));
  }
  return closure_views(std::move(targets));
}

// The least-squares problem.

TEST(ClosureProblem, TheSlopeOfTheCostIsThatOfDifferences) {
  const auto views = views_of(source_of(varying_network(), kSeparable));
  const ClosureProblem problem(views, {kGgx, kBeckmann}, kSeparable, {});
  ClosureUnknowns u(kClosureKnots, 15);
  for (int i = 0; i < u.size(); ++i) u.data()[i] = 0.4 + 0.2 * std::sin(1.7 * i);
  const auto n = problem.normal(u);
  for (int i = 0; i < u.size(); i += 7) {
    ClosureUnknowns up = u, down = u;
    up.data()[i] += 1e-3;
    down.data()[i] -= 1e-3;
    const double difference = (problem.cost(up) - problem.cost(down)) / 4e-3;  // the slope is half the derivative
    EXPECT_NEAR(n.slope[i], difference, 2e-3 * std::abs(difference) + 2e-4 * n.slope.norm()) << i;
  }
}

TEST(ClosureProblem, TheCostOfTheTruthIsZero) {
  const ClosureNetwork truth = network_of(Rgb(0.25f), {lobe_of(kGgx, Rgb(0.5f), 0.1f)});
  const auto views = views_of(source_of(truth, kSeparable));
  const ClosureBounds bounds;
  ClosureUnknowns u = ClosureUnknowns::Zero(kClosureKnots, 9);
  u.leftCols(3).setConstant(0.5);
  u.middleCols(3, 3).setConstant(std::sqrt(0.5));
  u.col(6).setConstant(closure_alpha_unknown(0.1, bounds));
  EXPECT_LT(ClosureProblem(views, {kGgx}, kSeparable, bounds).cost(u), 1e-4);
  EXPECT_GT(ClosureProblem(views, {kBeckmann}, kSeparable, bounds).cost(u), 0.05);
}

TEST(ClosureTarget, EmphasisAddsTheErrorOfTheRootAndKeepsIntegrals) {
  constexpr double kShare = 0.4, kChange = 0.02;
  const ClosureNetwork network = network_of(Rgb(0.4f), {lobe_of(kGgx, Rgb(0.5f), 0.1f)});
  ClosureNetwork changed = network;
  changed.diffuse.fill(Rgb(0.4f * (1 + static_cast<float>(kChange))));
  const ClosureSource source = source_of(network, kSeparable);
  const auto target_of = [&](const ClosureSource& s) {
    return closure_target(s, highlight_widths(source), radians_from(40.0f), 800);
  };
  const ClosureTarget plain = target_of(source), other = target_of(source_of(changed, kSeparable));
  ClosureTarget target = target_of(source);
  emphasize_dim(target, kShare);

  double error_sq = 0, root_error_sq = 0, weighted_sq = 0, albedo = 0;
  for (size_t i = 0; i < plain.lights.padded(); ++i) {
    const float weight = plain.lights.root_weight()[i];
    if (weight == 0) continue;
    const double f = plain.channel(1)[i] / weight, g = other.channel(1)[i] / weight, w = weight * weight;
    error_sq += w * (g - f) * (g - f);
    root_error_sq += w * std::pow(std::sqrt(g) - std::sqrt(f), 2);
    weighted_sq += std::pow(target.lights.root_weight()[i] * (g - f), 2);
    albedo += static_cast<double>(target.channel(1)[i] * target.integral.data()[i]);
  }
  const double sum = error_sq / plain.norm_sq.g + kShare * root_error_sq / plain.albedo.g;
  EXPECT_NEAR(weighted_sq / target.norm_sq.g * (1 + kShare / 4) / sum, 1, 0.05);
  EXPECT_GT(root_error_sq / plain.albedo.g, error_sq / plain.norm_sq.g);  // both matter to the sum
  EXPECT_NEAR(albedo, plain.albedo.g, 1e-4);
}

TEST(ClosureStarts, EachKindHasTheWidthOfTheMissingLobe) {
  const auto source = source_of(network_of(Rgb(0.2f), {lobe_of(kBeckmann, Rgb(0.3f), 0.06f)}), kSeparable);
  const ClosureBounds bounds;
  const std::vector<ClosureSolution> starts = closure_starts(views_of(source), {}, kSeparable, bounds);
  ASSERT_EQ(starts.size(), 4u);  // two distributions, toward the normal or the viewer
  EXPECT_NE(starts[0].distributions, starts[1].distributions);
  for (size_t i = 0; i < 2; ++i) {
    const ClosureSolution& start = starts[i];
    EXPECT_EQ(start.unknowns(kClosureKnots - 1, 7), 0);  // its tilt
    const double alpha = closure_shape(start.unknowns(0, 6), 0, 0, 0.5, bounds).alpha;
    EXPECT_TRUE(alpha > 0.03 && alpha < 0.12) << alpha;
  }
}

// Fits.

TEST(ClosureFit, RecoversALobeAndChoosesOne) {
  for (const LobeDistribution distribution : {kGgx, kBeckmann}) {
    const ClosureFit fit = fit_of(
        source_of(network_of({0.2f, 0.1f, 0.05f}, {lobe_of(distribution, {0.4f, 0.5f, 0.6f}, 0.15f)}), kSeparable));
    ASSERT_EQ(fit.network.lobes.size(), 1u);
    EXPECT_EQ(fit.network.lobes[0].distribution, distribution);
    for (const ClosureViewError& e : fit.errors) EXPECT_LT(e.rgb, 0.01) << e.degrees;
    for (const size_t i : {0u, 20u, 50u}) {
      EXPECT_NEAR(fit.network.lobes[0].roughness[i], std::sqrt(0.15f), 0.01f);
      EXPECT_NEAR(fit.network.lobes[0].weight[i].g, 0.5f, 0.01f);
      EXPECT_NEAR(fit.network.diffuse[i].r, 0.2f, 0.01f);
    }
  }
}

TEST(ClosureFit, RecoversTiltedAndStretchedLobes) {
  for (const LobeMasking masking : {kSeparable, kCorrelated}) {
    const ClosureNetwork network = varying_network(masking == kSeparable ? kGgx : kBeckmann);
    const ClosureFit fit =
        fit_of(source_of(network, masking), {.tolerance = 0.001, .max_lobes = 2, .masking = masking});
    for (const ClosureViewError& e : fit.errors) EXPECT_LT(e.luminance, 0.01) << e.degrees;
  }
}

TEST(ClosureFit, OneLobeCannotBeTwo) {
  const ClosureSource source = source_of(varying_network(kBeckmann), kCorrelated);
  EXPECT_GT(fit_of(source, {.max_lobes = 1, .masking = kCorrelated}).mean_error, 0.05);
  const ClosureFit fit = fit_of(source, {.masking = kCorrelated});
  EXPECT_EQ(fit.network.lobes.size(), 2u);
  EXPECT_LT(fit.mean_error, 0.03);
}

TEST(ClosureFit, AHazeOfAnotherColorGetsALobe) {
  const ClosureNetwork haze = network_of(
      Rgb(0), {lobe_of(kGgx, Rgb(0.6f, 0.5f, 0.4f), 0.05f), lobe_of(kBeckmann, {0.01f, 0.02f, 0.06f}, 0.4f)});
  const ClosureSource source = source_of(haze, kSeparable);
  const ClosureFit one = fit_of(source, {.max_lobes = 1}), fit = fit_of(source);
  EXPECT_LT(one.mean_error, 0.03);  // it adds next to nothing to luminance
  EXPECT_EQ(fit.network.lobes.size(), 2u);
  EXPECT_LT(visible_closure_error(fit.errors), 0.5 * visible_closure_error(one.errors));
}

TEST(ClosureFit, RecoversANarrowHighlight) {
  const ClosureFit fit = fit_of(source_of(network_of(Rgb(0.1f), {lobe_of(kGgx, Rgb(0.7f), 0.01f)}), kSeparable));
  ASSERT_EQ(fit.network.lobes.size(), 1u);
  EXPECT_NEAR(fit.network.lobes[0].roughness[30], 0.1f, 0.005f);
  EXPECT_LT(fit.mean_error, 0.02);
}

TEST(ClosureFit, RecoversRetroReflection) {
  const ClosureNetwork truth =
      network_of(Rgb(0.2f), {lobe_of(kGgx, Rgb(0.1f), 0.1f), lobe_of(kBeckmann, Rgb(0.4f), 0.03f, 0.99f)});
  const ClosureFit fit = fit_of(source_of(truth, kSeparable));
  ASSERT_EQ(fit.network.lobes.size(), 2u);
  EXPECT_LT(fit.mean_error, 0.03);
}

TEST(ClosureFit, NegativeControlAnotherMaskingIsSeen) {
  const ClosureNetwork network = network_of(Rgb(0), {lobe_of(kGgx, Rgb(0.8f), 0.5f)});
  const ClosureFit fit = fit_of(source_of(network, kSeparable), {.max_lobes = 1});
  const std::vector<Vec3> wl{direction(1.4f, kPi)};
  const auto value = [&](const ClosureNetwork& n, LobeMasking masking) {
    return test::values_of(n, masking, 1.4f, wl)[0].g;
  };
  EXPECT_NEAR(value(fit.network, kSeparable) / value(network, kSeparable), 1, 0.02);
  EXPECT_GT(value(fit.network, kCorrelated) / value(network, kSeparable), 1.1f);
}

TEST(ClosureFit, AlbedoIsThatOfTheSource) {
  const ClosureSource source =
      ggx_source({.alpha = Vec2(0.25f), .f0 = {0.9f, 0.3f, 0.04f}, .f90 = Rgb(1), .diffuse = {0, 0.3f, 0.1f}});
  const ClosureFit fit = fit_of(source, {.max_lobes = 1});
  EXPECT_LE(fit.albedo_excess, 0.01);
  const std::vector<Vec3> wl = hemisphere_fibonacci(20000);
  for (const float degrees : {3.0f, 33.0f, 63.0f, 83.0f}) {
    const std::vector<Rgb> truth = source_values(source, direction(radians_from(degrees), 0), wl);
    const std::vector<Rgb> fitted = test::values_of(fit.network, kSeparable, radians_from(degrees), wl);
    Vec3d expected(0), found(0);
    for (size_t i = 0; i < wl.size(); ++i) expected += truth[i], found += fitted[i];
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c] / expected[c], 1, 0.02) << degrees;
  }
}

TEST(ClosureAlbedo, NegativeControlExcessIsFoundAndRemoved) {
  Progress progress;
  ClosureNetwork network = network_of(Rgb(0.3f), {lobe_of(kGgx, Rgb(0.5f), 0.2f)});
  const ClosureSource source = source_of(network, kSeparable);
  const ClosureAlbedo albedo(source, highlight_widths(source), 0, progress);
  EXPECT_NEAR(albedo.largest_excess(network, kSeparable), 0, 1e-3);
  for (size_t i = 30; i < kClosureSamples; ++i) network.lobes[0].weight[i] *= Rgb(1.2f, 1, 0.7f);
  EXPECT_GT(albedo.largest_excess(network, kSeparable), 0.05);
  albedo.correct(network, kSeparable);
  EXPECT_LE(albedo.largest_excess(network, kSeparable), 0.01);
  EXPECT_GT(network.diffuse[40].b, 0.3f);  // what was missing is added
}

TEST(ClosureFit, DoesNotDependOnThreads) {
  const ClosureSource source = source_of(varying_network(), kSeparable);
  const ClosureFit one = fit_of(source, {.tolerance = 1e-6, .max_lobes = 2, .threads = 1}),
                   two = fit_of(source, {.tolerance = 1e-6, .max_lobes = 2, .threads = 2});
  EXPECT_EQ(one.network.diffuse, two.network.diffuse);
  ASSERT_EQ(one.network.lobes.size(), two.network.lobes.size());
  for (size_t k = 0; k < one.network.lobes.size(); ++k) {
    EXPECT_EQ(one.network.lobes[k].weight, two.network.lobes[k].weight);
    EXPECT_EQ(one.network.lobes[k].roughness, two.network.lobes[k].roughness);
    EXPECT_EQ(one.network.lobes[k].tilt, two.network.lobes[k].tilt);
    EXPECT_EQ(one.network.lobes[k].anisotropy, two.network.lobes[k].anisotropy);
  }
}

TEST(ClosureFit, LobesAreRoundAtTheNormal) {
  ClosureLobe lobe = lobe_of(kGgx, Rgb(0.5f), 0.2f, 0, 0.5f);
  lobe.anisotropy[0] = 0, lobe.anisotropy[1] = 0.14f, lobe.anisotropy[2] = 0.39f;
  const ClosureFit fit = fit_of(source_of(network_of(Rgb(0), {lobe}), kSeparable), {.max_lobes = 1});
  EXPECT_EQ(fit.network.lobes[0].anisotropy[0], 0);
  EXPECT_NEAR(fit.network.lobes[0].anisotropy[3], 0.5f, 0.03f);
  EXPECT_LT(fit.mean_error, 0.01);
}

/// A brushed network: a lobe six times as wide along x that fades toward grazing views.
ClosureNetwork brushed_network(LobeDistribution distribution = kGgx) {
  ClosureNetwork network = network_of({0.05f, 0.03f, 0.02f}, {lobe_of(distribution, Rgb(1), 0.12f, 0, 0.9f)});
  network.frame = ClosureFrame::surface;
  for (size_t i = 0; i < kClosureSamples; ++i) {
    const float x = static_cast<float>(i) / (kClosureSamples - 1);
    network.lobes[0].weight[i] = Rgb(0.8f, 0.7f, 0.6f) * (1 - 0.4f * x * x);
  }
  return network;
}

TEST(ClosureFit, RecoversABrushedLobe) {
  for (const LobeMasking masking : {kSeparable, kCorrelated}) {
    const LobeDistribution distribution = masking == kSeparable ? kGgx : kBeckmann;
    const ClosureFit fit = fit_of(source_of(brushed_network(distribution), masking), {.masking = masking});
    ASSERT_EQ(fit.network.lobes.size(), 1u);
    EXPECT_EQ(fit.network.frame, ClosureFrame::surface);
    const ClosureLobe& lobe = fit.network.lobes[0];
    EXPECT_EQ(lobe.distribution, distribution);
    for (const size_t i : {0u, 30u}) {
      EXPECT_NEAR(lobe.roughness[i], std::sqrt(0.12f), 0.01f);
      EXPECT_NEAR(lobe.anisotropy[i], 0.9f, 0.05f);
      EXPECT_EQ(lobe.tilt[i], 0);
    }
    EXPECT_LT(fit.mean_error, 0.02);
    EXPECT_LE(fit.albedo_excess, 0.01);
  }
}

TEST(ClosureFit, BeckmannLobesAreRoundBeforeBlender35) {
  const ClosureFit fit = fit_of(source_of(varying_network(kBeckmann), kSeparable));
  ASSERT_EQ(fit.network.lobes.size(), 2u);
  for (const ClosureLobe& lobe : fit.network.lobes) {
    if (lobe.distribution == kBeckmann) {
      EXPECT_EQ(lobe.anisotropy, ClosureCurve<float>{});
    }
  }
  const ClosureFit brushed = fit_of(source_of(brushed_network(kBeckmann), kSeparable));
  EXPECT_NE(brushed.network.lobes[0].distribution, kBeckmann);
  EXPECT_LT(brushed.mean_error, 0.1);
}

TEST(ClosureFit, NegativeControlARoundLobeIsFarFromABrushedOne) {
  ClosureNetwork network = brushed_network();
  const ClosureSource source = source_of(network, kSeparable);
  Progress progress;
  const ClosureJudge judge(source, highlight_widths(source), 0, progress);
  EXPECT_LT(mean_closure_error(judge.errors(network, kSeparable)), 1e-3);
  network.lobes[0].anisotropy.fill(0);
  EXPECT_GT(mean_closure_error(judge.errors(network, kSeparable)), 0.2);
}

TEST(ClosureFit, BlackMaterialsGiveBlackNetworks) {
  const ClosureFit fit = fit_of(source_of(network_of(Rgb(0), {}), kSeparable));
  EXPECT_EQ(test::values_of(fit.network, kSeparable, 0.5f, {direction(0.4f, 1)})[0], Rgb(0));
  EXPECT_EQ(fit.mean_error, 0);
}

TEST(ClosureFit, RefusesOptionsOutOfRange) {
  const ClosureSource source = source_of(varying_network(), kSeparable);
  EXPECT_THROW(fit_of(source, {.max_lobes = 4}), Error);
  EXPECT_THROW(fit_of(source, {.max_lobes = 0}), Error);
  EXPECT_THROW(fit_of(source, {.tolerance = -0.1}), Error);
}

TEST(ClosureFit, StopsAtACancel) {
  Progress progress;
  progress.cancel();
  EXPECT_THROW(fit_closures(source_of(varying_network(), kSeparable), {}, progress), Error);
}

// Closures of measurements.

TEST(ModelClosures, ShowBrushedMaterialsAsWellAsPlainOnes) {
  for (const Vec2 alpha : {Vec2(0.2f), Vec2(0.1f, 0.4f)}) {
    Progress progress;
    const auto material = make_ggx_material({.alpha = alpha, .f0 = Rgb(0.8f), .f90 = Rgb(1)});
    const ModelClosures closures = fit_measurement_closures(MaterialMeasurement(material), {}, progress);
    EXPECT_LT(closures.fit.mean_error, 0.04) << alpha.y;
    EXPECT_EQ(closures.reason, "");
    EXPECT_GT(closures.seconds, 0);
  }
}

}  // namespace
}  // namespace velour::closure_fit_test
