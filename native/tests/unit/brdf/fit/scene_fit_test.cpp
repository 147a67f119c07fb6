#include "brdf/fit/scene_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "brdf/fit/fit_model.h"
#include "brdf/fit/parametric/parametric_fit.h"
#include "support/analytic_measurement.h"
#include "support/example_shell.h"
#include "support/level.h"
#include "support/parametric_models.h"
#include "support/soft_light.h"
#include "usage/picture_error.h"

namespace velour::scene_fit_test {
namespace {

using test::AnalyticMeasurement;

const ParametricBrdf& lobes_of(const Model& model) { return std::get<ParametricBrdf>(model.body); }

std::shared_ptr<const SceneObservation> soft_scene() {
  return std::make_shared<const SceneObservation>(test::softly_lit(256, 64, 30, 50));
}

/// A measurement whose f is `factor` times that of `brdf`.
AnalyticMeasurement measured(const ParametricBrdf& brdf, double factor) {
  return AnalyticMeasurement([brdf, factor](const DirectionPair& p) {
    Vec3d f(0);
    for (const WarpedLobe& lobe : lobes_at(brdf, Vec3d(p.wv))) {
      f += factor * lobe.coefficient * warped_kernel(lobe, Vec3d(p.wl), Vec3d(p.wv));
    }
    return Rgb(f);
  });
}

class PictureErrorTest : public ::testing::Test {
 protected:
  PictureErrorEstimate error_of(const ParametricBrdf& model, const Measurement& measurement) {
    const PictureError judge(measurement, model, *scene_, 1, progress_);
    return PictureError::estimate(judge.shares(model));
  }

  const ParametricBrdf brdf_ = *test::parametric_highlight(30, true);
  std::shared_ptr<const SceneObservation> scene_ = soft_scene();
  Progress progress_;
};

TEST_F(PictureErrorTest, IsZeroForTheMeasurementItself) {
  EXPECT_LT(error_of(brdf_, measured(brdf_, 1)).relmse, 1e-12);
}

TEST_F(PictureErrorTest, AFactorIsItsSquare) {
  // Every pixel is 10 % off: relmse is 0.01 but for the 0.01 mean(r)^2 under the fraction.
  const PictureErrorEstimate error = error_of(brdf_, measured(brdf_, 1 / 1.1));
  EXPECT_NEAR(error.relmse, 0.01 / 1.01, 2e-4);
  EXPECT_LT(error.standard_error, 2e-4);
}

TEST_F(PictureErrorTest, NoiseOfFewTermsCancels) {
  // An error that is 0 in the mean over the lights of a picture, though large at each light.
  const AnalyticMeasurement stripes([](const DirectionPair& p) {
    const Rgb base = Rgb(0.3f);
    return std::sin(900 * p.wl.x) > 0 ? 1.3f * base : 0.7f * base;
  });
  ParametricBrdf flat = test::parametric_model(true, {{LobeSpace::light, 1e-4f, Rgb(0.3f)}});
  const SceneObservation few = test::softly_lit(1024, 8, 30, 50);
  const PictureError judge(stripes, flat, few, 1, progress_);
  const PictureErrorEstimate error = PictureError::estimate(judge.shares(flat));
  EXPECT_LT(std::abs(error.relmse), 4 * error.standard_error);
  EXPECT_LT(error.standard_error, 1e-3);  // one half squared would have found 0.3^2 / 8 = 0.011
}

TEST_F(PictureErrorTest, ColorsAreRefinedTowardsThePictures) {
  const AnalyticMeasurement brighter = measured(brdf_, 1.2);
  const PictureError judge(brighter, brdf_, *scene_, 1, progress_);
  ParametricBrdf refined = brdf_;
  judge.refine_colors(refined);
  const double before = PictureError::estimate(judge.shares(brdf_)).relmse;
  const double after = PictureError::estimate(judge.shares(refined)).relmse;
  EXPECT_GT(before, 0.02);
  EXPECT_LT(after, 1e-3 * before);
}

TEST(LightImportance, FollowsTheLightAndLeavesNothingOut) {
  // All light from the side of the view: by isotropy any azimuth of the pair counts.
  const Vec3 side = direction(0.6f, 0.3f);
  const auto light = [&](const Vec3&) {
    return [&](const Vec3& wl) { return glm::dot(wl, side) > 0.9f ? 5.0f : 0.0f; };
  };
  SceneObservation scene = test::observed(512, 64, 40, 40.5f, light);
  for (ObservedHit& hit : scene.hits) hit.wv = direction(0.7f, 0.3f);
  const LightImportance importance(scene);
  const Vec3 wv = direction(0.7f, 2);
  EXPECT_GT(importance(wv, direction(0.6f, 2)), 3);
  EXPECT_EQ(importance(wv, direction(0.6f, 2 + kPi)), 0.1);
}

class SceneFit : public ::testing::Test {
 protected:
  Model reduced(const Measurement& measurement, std::shared_ptr<const SceneObservation> scene) {
    FitOptions options;
    options.for_scene = std::move(scene);
    options.full_model = full_;
    return fit_for_scene(measurement, options, progress_);
  }
  std::shared_ptr<const Model> full(const Measurement& measurement) {
    return full_ = std::make_shared<const Model>(fit_parametric(measurement, {}, progress_));
  }
  double error_in(const SceneObservation& scene, const Measurement& measurement, const ParametricBrdf& brdf) {
    const PictureError judge(measurement, lobes_of(*full_), scene, 0, progress_);
    return PictureError::estimate(judge.shares(brdf)).relmse;
  }

  Progress progress_;
  std::shared_ptr<const Model> full_;
};

TEST_F(SceneFit, ShrinksAModelThatIsSeenUnderSoftLightFromFewViews) {
  const AnalyticMeasurement metal(test::ggx(0.2f, 0.2f));
  full(metal);
  const Model model = reduced(metal, soft_scene());
  const ParametricBrdf& small = lobes_of(model);
  EXPECT_LE(3 * small.parameter_bytes(), lobes_of(*full_).parameter_bytes());
  EXPECT_EQ(small.views.begin, 29);
  EXPECT_EQ(small.views.end, 51);
  ASSERT_TRUE(model.scene);
  EXPECT_EQ(model.scene->full_parameter_bytes, lobes_of(*full_).parameter_bytes());
  EXPECT_FALSE(model.fit.by_view_angle.at("5"));
  EXPECT_TRUE(model.fit.by_view_angle.at("30"));
  // Judged by other hits under other light of the same kind.
  const SceneObservation other = test::softly_lit(1024, 128, 30, 50, 99);
  EXPECT_LE(error_in(other, metal, small), 1.1 * error_in(other, metal, lobes_of(*full_)));
}

TEST_F(SceneFit, KeepsTheShellOfTheFullModel) {
  const AnalyticMeasurement metal(test::ggx(0.2f, 0.2f));
  Model with_shell = *full(metal);
  with_shell.shell = ModelShell{test::wires(16, 0.2f), "wires"};
  full_ = std::make_shared<const Model>(with_shell);
  const Model model = reduced(metal, soft_scene());
  EXPECT_LT(lobes_of(model).parameter_bytes(), lobes_of(*full_).parameter_bytes());
  ASSERT_TRUE(model.shell);
  EXPECT_EQ(model.shell->volume, with_shell.shell->volume);
}

/// The full model is the measurement, so that any other is worse.
TEST_F(SceneFit, WhatNoPictureShowsTakesNoBytes) {
  const ParametricBrdf even = lobes_of(*full(AnalyticMeasurement(test::lambert)));
  const AnalyticMeasurement measurement = measured(even, 1);
  const Model model = reduced(measurement, soft_scene());
  EXPECT_LT(2 * lobes_of(model).parameter_bytes(), even.parameter_bytes());
  EXPECT_LE(error_in(*soft_scene(), measurement, even), 1e-15);
  EXPECT_LE(error_in(*soft_scene(), measurement, lobes_of(model)), 2e-6);
}

TEST_F(SceneFit, MoreViewsTakeMoreBytes) {
  VELOUR_LONG_TEST();
  const AnalyticMeasurement metal(test::ggx(0.2f, 0.2f));
  full(metal);
  const auto everywhere = std::make_shared<const SceneObservation>(test::softly_lit(256, 64, 0, 89.5f));
  const ParametricBrdf all = lobes_of(reduced(metal, everywhere)), few = lobes_of(reduced(metal, soft_scene()));
  EXPECT_TRUE(all.views.whole());
  EXPECT_LE(all.parameter_bytes(), lobes_of(*full_).parameter_bytes());
  EXPECT_GT(all.parameter_bytes(), few.parameter_bytes());
}

TEST_F(SceneFit, DoesNotDependOnThreads) {
  const AnalyticMeasurement metal(test::ggx(0.3f, 0.3f));
  full(metal);
  FitOptions options;
  options.for_scene = soft_scene();
  options.full_model = full_;
  options.threads = 1;
  const Model one = fit_for_scene(metal, options, progress_);
  options.threads = 2;
  EXPECT_EQ(lobes_of(one).control, lobes_of(fit_for_scene(metal, options, progress_)).control);
}

TEST_F(SceneFit, TheFullModelIsNotAllOfTheProgress) {
  const auto scene = soft_scene();
  double at_the_hits = 0;  // they are measured between the full model and the search
  const auto metal = test::ggx(0.3f, 0.3f);
  const AnalyticMeasurement watched([&](const DirectionPair& p) {
    if (p.wl == scene->wl[0]) at_the_hits = progress_.fraction();
    return metal(p);
  });
  FitOptions options;
  options.for_scene = scene;
  options.threads = 1;
  fit_for_scene(watched, options, progress_);
  EXPECT_GE(at_the_hits, 0.5);
  EXPECT_LE(at_the_hits, 0.61);
  EXPECT_EQ(progress_.fraction(), 1);
}

TEST_F(SceneFit, ABoundOnBytesIsKept) {
  const AnalyticMeasurement metal(test::ggx(0.2f, 0.2f));
  full(metal);
  FitOptions options;
  options.for_scene = soft_scene();
  options.full_model = full_;
  options.max_bytes = 1;
  EXPECT_THROW(fit_model(ModelKind::parametric, metal, options, progress_), Error);
  options.max_bytes = 10000;
  EXPECT_LE(lobes_of(fit_model(ModelKind::parametric, metal, options, progress_)).parameter_bytes(), 10000u);
}

TEST_F(SceneFit, RefusesWhatMakesNoSense) {
  const AnalyticMeasurement diffuse(test::lambert);
  full(diffuse);
  EXPECT_THROW(reduced(diffuse, std::make_shared<const SceneObservation>()), Error);
  EXPECT_THROW(reduced(AnalyticMeasurement(test::ggx(0.1f, 0.3f), false), soft_scene()), Error);
  full_ = std::make_shared<const Model>(reduced(diffuse, soft_scene()));
  EXPECT_THROW(reduced(diffuse, soft_scene()), Error);  // of a model that is itself reduced
}

}  // namespace
}  // namespace velour::scene_fit_test
