#include "verdict/verdict.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "brdf/eval/parametric_material.h"
#include "brdf/fit/error/evaluate.h"
#include "brdf/fit/fit_model.h"
#include "model/model.h"
#include "support/analytic_measurement.h"
#include "support/level.h"
#include "support/parametric_models.h"
#include "support/test_data.h"
#include "verdict/surroundings.h"

namespace velour::verdict_test {
namespace {

using test::AnalyticMeasurement;

/// Materials that nobody confuses: an off-white matte one, a blue gloss paint, rough gold, a sharp metal.
std::vector<std::shared_ptr<const Material>> materials() {
  using Lobes = std::vector<test::LobeRecipe>;
  const Lobes matte{{LobeSpace::half, 0.5f, Rgb(0.2f, 0.19f, 0.17f)}};
  const Lobes paint{{LobeSpace::half, 0.5f, {0.005f, 0.02f, 0.12f}}, {LobeSpace::half, 600, Rgb(4), 0, 0, 1}};
  const Lobes gold{{LobeSpace::half, 12, {0.9f, 0.6f, 0.2f}}};
  const Lobes metal{{LobeSpace::half, 2000, Rgb(60)}};
  std::vector<std::shared_ptr<const Material>> out;
  for (const Lobes& lobes : {matte, paint, gold, metal}) {
    out.push_back(make_parametric_material(std::make_shared<ParametricBrdf>(test::parametric_model(true, lobes))));
  }
  return out;
}

Verdict judged(const Measurement& measurement, const Material& material, int threads = 0) {
  Progress progress;
  return judge_look(measurement, material, true, threads, progress).value();
}

/// f of a material times a factor.
using Factor = std::function<Rgb(const DirectionPair&)>;
AnalyticMeasurement changed(const std::shared_ptr<const Material>& material, const Factor& factor) {
  return AnalyticMeasurement([=](const DirectionPair& pair) {
    Rgb f;
    evaluate(*material, pair.wv, {&pair.wl, 1}, {&f, 1});
    return f * factor(pair);
  });
}

TEST(Verdict, AnExactCopyDoesNotDiffer) {
  for (const auto& material : materials()) {
    const Verdict verdict = judged(MaterialMeasurement(material), *material);
    EXPECT_EQ(verdict, Verdict{}) << verdict.flip_mean;
  }
}

TEST(Verdict, AnotherMaterialIsPoor) {
  const auto all = materials();
  for (size_t i = 0; i < all.size(); ++i) {
    const Verdict verdict = judged(MaterialMeasurement(all[i]), *all[(i + 1) % all.size()]);
    EXPECT_EQ(verdict.quality, LookQuality::poor) << i << ": " << verdict.flip_mean;
    EXPECT_NE(verdict.reason, LookReason::none);
  }
}

TEST(Verdict, ThreadsDoNotMatter) {
  const auto all = materials();
  const Verdict one = judged(MaterialMeasurement(all[1]), *all[2], 1),
                four = judged(MaterialMeasurement(all[1]), *all[2], 4);
  EXPECT_EQ(one, four);
  EXPECT_GT(one.flip_mean, 0);
}

TEST(Verdict, OneLobeForAPaintIsPoor) {
  const auto base = test::ggx(0.15f, 0.15f);
  const AnalyticMeasurement paint([&](const DirectionPair& p) { return 0.3f * test::lambert(p) + 0.3f * base(p); });
  Progress progress;
  FitOptions options;
  options.max_lobes = 1;
  const auto model = std::make_shared<const Model>(fit_model(ModelKind::parametric, paint, options, progress));
  EXPECT_EQ(judged(paint, *make_material(model, 0)).quality, LookQuality::poor);
  EXPECT_EQ(model->fit.verdict, std::nullopt) << "who fits judges";
}

TEST(Verdict, NamesWhatDiffers) {
  const auto matte = materials()[0], paint = materials()[1];
  struct Case {
    const std::shared_ptr<const Material>& material;
    Factor factor;
    LookReason reason;
  };
  const auto plain = [](double factor) { return Rgb(static_cast<float>(factor)); };
  const auto is_mirror = [](const DirectionPair& p) { return glm::normalize(p.wl + p.wv).z > 0.99f; };
  const Case cases[] = {
      {matte, [&](const DirectionPair&) { return plain(0.5); }, LookReason::brightness},
      {paint, [&](const DirectionPair&) { return plain(0.2); }, LookReason::brightness},  // the model is cut off
      {matte, [](const DirectionPair&) { return Rgb(1.3f, 1, 0.2f); }, LookReason::color},
      {paint, [&](const DirectionPair& p) { return plain(is_mirror(p) ? 0.3 : 1); }, LookReason::highlights},
      {matte, [&](const DirectionPair& p) { return plain(p.wv.z > 0.5f ? 1 : 2); }, LookReason::grazing_views},
      {matte, [&](const DirectionPair& p) { return plain(p.wl.z > p.wv.z ? 1.6 : 0.6); },
       LookReason::measurement_noise},
  };
  for (const Case& c : cases) {
    const Verdict verdict = judged(changed(c.material, c.factor), *c.material);
    EXPECT_EQ(verdict.reason, c.reason) << static_cast<int>(c.reason) << ", mean " << verdict.flip_mean;
    EXPECT_NE(verdict.quality, LookQuality::good);
  }
  EXPECT_NEAR(judged(changed(matte, [&](const DirectionPair&) { return plain(0.5); }), *matte).value, 2, 1e-3);
}

TEST(Verdict, ASmallDifferenceIsGood) {
  const auto matte = materials()[0];
  const Verdict verdict = judged(changed(matte, [](const DirectionPair&) { return Rgb(1.02f); }), *matte);
  EXPECT_EQ(verdict.quality, LookQuality::good);
  EXPECT_GT(verdict.flip_mean, 0);
}

TEST(Verdict, ATurnedBrushingIsNotGood) {
  const auto brushed = [](float stretch) {
    return make_parametric_material(std::make_shared<ParametricBrdf>(
        test::parametric_model(false, {{LobeSpace::half, 30, Rgb(0.5f, 0.4f, 0.3f), 0, stretch}})));
  };
  EXPECT_EQ(judged(MaterialMeasurement(brushed(1.2f)), *brushed(1.2f)).flip_mean, 0);
  EXPECT_NE(judged(MaterialMeasurement(brushed(1.2f)), *brushed(-1.2f)).quality, LookQuality::good);
}

TEST(Verdict, NothingIsSaidOfWhatIsNotMeasured) {
  AnalyticMeasurement none(test::lambert);
  none.set_coverage([](const DirectionPair&) { return false; });
  Progress progress;
  EXPECT_EQ(judge_look(none, *materials()[0], true, 0, progress), std::nullopt);
  const auto matte = materials()[0];
  AnalyticMeasurement part = changed(matte, [](const DirectionPair&) { return Rgb(1); });
  part.set_coverage([](const DirectionPair& p) { return p.wl.x > 0 && p.wv.z > 0.3f; });
  EXPECT_LT(judged(part, *matte).flip_mean, 1e-5) << "what is not covered is black in neither picture";
}

TEST(Verdict, IsLoweredForSamplesThatItsPicturesDoNotShow) {
  FitRecord record;
  record.by_view_angle = {{"5", 0.9}, {"85", std::nullopt}};
  Verdict verdict;
  lower_for_samples(record, verdict);
  EXPECT_EQ(verdict.quality, LookQuality::good);
  record.by_view_angle["5"] = 1.2;
  record.all_data = true;  // the errors are those of fitted samples
  lower_for_samples(record, verdict);
  EXPECT_EQ(verdict.quality, LookQuality::good);
  record.all_data = false;
  lower_for_samples(record, verdict);
  EXPECT_EQ(verdict.quality, LookQuality::fair);
  EXPECT_EQ(verdict.reason, LookReason::held_out_samples);
  record.warnings.push_back(warning<WarningCode::anisotropic_samples>(
      {{"pairs", size_t{200}}, {"factor", 5.0}, {"same_azimuth_factor", 1.1}}));
  lower_for_samples(record, verdict);
  EXPECT_EQ(verdict.quality, LookQuality::poor);
  EXPECT_EQ(verdict.reason, LookReason::anisotropic_samples);
}

TEST(Verdict, ACancelStopsIt) {
  Progress progress;
  progress.cancel();
  EXPECT_THROW(judge_look(AnalyticMeasurement(test::lambert), *materials()[0], true, 1, progress), Error);
}

/// The middle of the ball, whose normal is the view: against a sum over the whole environment.
TEST(Pictures, SumTheLight) {
  const auto matte = materials()[0];
  Progress progress;
  const auto pairs = picture_pairs(MaterialMeasurement(matte), *matte, Against::measurement, 0, progress);
  ASSERT_EQ(pairs.size(), 6u);
  const Surroundings surroundings;
  const std::vector<Vec3> lights = hemisphere_fibonacci(20000);
  std::vector<Rgb> f(lights.size());
  evaluate(*matte, glm::normalize(Vec3(0.01f, 0, 1)), lights, f);
  const double solid_angle = 2 * kPiD / static_cast<double>(lights.size());
  Surroundings::Lights lit;
  for (size_t i = 0; i < lights.size(); ++i) {
    lit.add(surroundings, lights[i], solid_angle, {f[i] * lights[i].z * static_cast<float>(solid_angle), Rgb(0)});
  }
  const Surroundings::Radiance whole = surroundings.reflected(Frame(), lit)[0];
  for (size_t e = 0; e < Surroundings::kCount; ++e) {
    const Rgb sum(whole[4 * e], whole[4 * e + 1], whole[4 * e + 2]);
    const PicturePair& ball = pairs[e];
    const auto side = static_cast<size_t>(ball.measured.width);
    const Rgb middle = ball.measured.pixels[(side / 2) * side + side / 2] / static_cast<float>(ball.exposure);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(middle[c] / sum[c], 1, 0.08) << "environment " << e;
  }
}

TEST(Pictures, AreExposedAlike) {
  const auto matte = materials()[0];
  Progress progress;
  for (const PicturePair& pair : picture_pairs(MaterialMeasurement(matte), *matte, Against::measurement, 0, progress)) {
    double sum = 0;
    for (const uint32_t pixel : pair.object) sum += luminance(pair.measured.pixels[pixel]);
    EXPECT_NEAR(sum / static_cast<double>(pair.object.size()), 0.18, 0.02);  // a few pixels are cut off
    EXPECT_NEAR(pair.luminance_ratio, 1, 1e-6);
    EXPECT_GT(pair.object.size(), pair.measured.pixels.size() / 3);
  }
}

/// The fits of shared measurements look like them, and unlike others.
TEST(Verdict, SharedMaterials) {
  VELOUR_LONG_TEST();
  std::vector<std::shared_ptr<const Measurement>> measured;
  std::vector<std::shared_ptr<const Model>> models;
  for (const char* file :
       {"krylon_blue.brdf", "cc_iris_purple_gem_rgb.bsdf", "paper_white_rgb.bsdf", "satin_rosaline_rgb.bsdf"}) {
    VELOUR_NEED_DATA(path, std::string("brdf/") + file);
    measured.push_back(load_measurement(path.string()));
    Progress progress;
    models.push_back(std::make_shared<const Model>(fit_model(kDefaultModelKind, *measured.back(), {}, progress)));
  }
  for (size_t i = 0; i < measured.size(); ++i) {
    for (size_t j = 0; j < models.size(); ++j) {
      const Verdict verdict = judged(*measured[i], *make_material(models[j], 0));
      EXPECT_EQ(verdict.quality == LookQuality::poor, i != j) << i << " " << j << ": " << verdict.flip_mean;
    }
  }
}

}  // namespace
}  // namespace velour::verdict_test
