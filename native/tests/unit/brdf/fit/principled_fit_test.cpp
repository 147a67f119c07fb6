#include "brdf/fit/peer.h"

#include <gtest/gtest.h>

#include "brdf/fit/error/evaluate.h"
#include "material/principled/principled_material.h"
#include "support/analytic_measurement.h"
#include "support/test_data.h"

namespace velour::principled_fit_test {
namespace {

using test::AnalyticMeasurement;

AnalyticMeasurement measurement_of(const PrincipledParameters& p) {
  const auto material = make_principled_material(p);
  return AnalyticMeasurement([material](const DirectionPair& w) {
    Rgb f;
    evaluate(*material, w.wv, {&w.wl, 1}, {&f, 1});
    return f;
  });
}

std::vector<PrincipledParameters> known_materials() {
  return {{.base_color = {0.2f, 0.5f, 0.8f}, .roughness = 0.4f, .specular = 0.7f},
          {.base_color = {0.9f, 0.6f, 0.3f}, .metallic = 1, .roughness = 0.2f, .specular_tint = {0.5f, 0.7f, 0.9f}},
          {.base_color = {0.7f, 0.1f, 0.1f}, .metallic = 1, .roughness = 0.6f, .coat = 0.8f, .coat_roughness = 0.15f}};
}

TEST(PrincipledFit, RecoversKnownMaterials) {
  Progress progress;
  for (const PrincipledParameters& truth : known_materials()) {
    const PeerFit fit = judge_peer(measurement_of(truth), Peer::principled, 2, progress);
    const auto& found = std::get<PrincipledParameters>(fit.parameters);
    EXPECT_LT(fit.error.relative_l2, 0.01) << truth.metallic << truth.coat;
    EXPECT_NEAR(found.metallic, truth.metallic, 0.02);
    EXPECT_NEAR(found.roughness, truth.roughness, 0.02);
    EXPECT_NEAR(found.coat, truth.coat, 0.05);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found.base_color[c], truth.base_color[c], 0.02) << c;
  }
}

TEST(PrincipledFit, NegativeControlAnotherRoughnessIsNotFound) {
  Progress progress;
  const PrincipledParameters truth = known_materials()[0];
  const PrincipledParameters found = fit_principled(measurement_of(truth), PrincipledSet::all, 2, progress);
  EXPECT_GT(std::abs(found.roughness - 1.1f * truth.roughness), 0.02f);
}

// The plain set fits a coated metal without a coat, worse than the full set. It fits an uncoated material well.
TEST(PrincipledFit, ThePlainSetHasNeitherCoatNorTint) {
  Progress progress;
  const auto coated = measurement_of(known_materials()[2]);
  const PeerFit plain = judge_peer(coated, Peer::plain_principled, 2, progress);
  const PeerFit full = judge_peer(coated, Peer::principled, 2, progress);
  const auto& found = std::get<PrincipledParameters>(plain.parameters);
  EXPECT_EQ(found.coat, 0);
  EXPECT_EQ(found.specular_tint, Rgb(1));
  EXPECT_GT(plain.error.relative_l2, 2 * full.error.relative_l2);
  const auto bare = judge_peer(measurement_of(known_materials()[0]), Peer::plain_principled, 2, progress);
  EXPECT_LT(bare.error.relative_l2, 0.01);
}

// A model is seen as its measurement is, and not at views that it is not made for.
TEST(PrincipledFit, RecoversAMaterialFromItself) {
  Progress progress;
  const PrincipledParameters truth = known_materials()[0];
  const MaterialMeasurement seen(make_principled_material(truth), {.begin = 0, .end = 70});
  const PeerFit fit = judge_peer(seen, Peer::principled, 2, progress);
  EXPECT_NEAR(std::get<PrincipledParameters>(fit.parameters).roughness, truth.roughness, 0.02);
  EXPECT_LT(fit.error.relative_l2, 0.01);
  EXPECT_TRUE(fit.error.by_view_angle.at("60").has_value());
  EXPECT_FALSE(fit.error.by_view_angle.at("75").has_value());
}

TEST(PrincipledFit, DoesNotDependOnThreads) {
  const auto measurement = AnalyticMeasurement(test::ggx(0.2f, 0.2f));
  Progress progress;
  const auto one = fit_principled(measurement, PrincipledSet::all, 1, progress);
  const auto two = fit_principled(measurement, PrincipledSet::all, 2, progress);
  EXPECT_EQ(one.base_color, two.base_color);
  EXPECT_EQ(one.specular_tint, two.specular_tint);
  for (const auto member : PrincipledProblem::kShape) EXPECT_EQ(one.*member, two.*member);
}

TEST(PrincipledFit, UncoveredDataGiveABlackMaterial) {
  Progress progress;
  AnalyticMeasurement nothing(test::lambert);
  nothing.set_coverage([](const DirectionPair&) { return false; });
  const PrincipledParameters black = fit_principled(nothing, PrincipledSet::all, 1, progress);
  EXPECT_EQ(black.base_color, Rgb(0));
  EXPECT_EQ(black.specular, 0);
}

TEST(PrincipledFit, StopsAtACancel) {
  Progress progress;
  progress.cancel();
  EXPECT_THROW(fit_principled(AnalyticMeasurement(test::lambert), PrincipledSet::all, 2, progress), Error);
}

TEST(PrincipledFit, FollowsARealPaper) {
  VELOUR_NEED_DATA(path, "brdf/paper_white_rgb.bsdf");
  Progress progress;
  const PeerFit fit = judge_peer(*load_measurement(path.string()), Peer::principled, 2, progress);
  EXPECT_LT(fit.error.relative_l2, 0.06);
  EXPECT_LT(std::get<PrincipledParameters>(fit.parameters).metallic, 0.1f);
}

// The model of the cost that a descent steps by must be the cost's own.
TEST(PrincipledProblem, SlopeIsThatOfItsCost) {
  Progress progress;
  const PrincipledProblem problem(pair_samples(AnalyticMeasurement(test::ggx(0.2f, 0.2f)), 2, progress));
  const PrincipledParameters p{.base_color = {0.3f, 0.5f, 0.7f},
                               .metallic = 0.4f,
                               .roughness = 0.45f,
                               .specular = 0.4f,
                               .specular_tint = Rgb(0.6f),
                               .coat = 0.3f,
                               .coat_roughness = 0.3f};
  const auto n = problem.normal(p);
  for (size_t k = 0; k < PrincipledProblem::kShape.size(); ++k) {
    PrincipledParameters above = p, below = p;
    above.*PrincipledProblem::kShape[k] += 0.003f;
    below.*PrincipledProblem::kShape[k] -= 0.003f;
    const double slope = (problem.cost(above) - problem.cost(below)) / 0.006;
    EXPECT_NEAR(2 * n.slope[6 + static_cast<int>(k)], slope, 0.03 * std::abs(slope) + 1e-3) << k;
  }
}

}  // namespace
}  // namespace velour::principled_fit_test
