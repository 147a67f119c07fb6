#include "model/file/model_file.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/error.h"
#include "base/file.h"
#include "brdf/model/per_view_brdf.h"
#include "example_model.h"
#include "model/model.h"
#include "support/test_data.h"
#include "support/warnings.h"

namespace velour::model_file_test {
namespace {

using test::example_model;

using test::example_parametric;

const PerViewBrdf& scattered(const Model& model) { return std::get<PerViewBrdf>(model.body); }
const ParametricBrdf& parametric(const Model& model) { return std::get<ParametricBrdf>(model.body); }

void expect_same_record(const Model& a, const Model& b) {
  EXPECT_EQ(a.fit.relative_l2, b.fit.relative_l2);
  EXPECT_EQ(a.fit.by_view_angle, b.fit.by_view_angle);
  EXPECT_EQ(a.fit.albedo_by_view_angle, b.fit.albedo_by_view_angle);
  EXPECT_EQ(a.fit.albedo_max, b.fit.albedo_max);
  EXPECT_EQ(a.fit.reciprocity, b.fit.reciprocity);
  EXPECT_EQ(a.fit.measured_reciprocity, b.fit.measured_reciprocity);
  EXPECT_EQ(a.fit.tolerance, b.fit.tolerance);
  EXPECT_EQ(a.fit.seed, b.fit.seed);
  EXPECT_EQ(a.fit.all_data, b.fit.all_data);
  EXPECT_EQ(a.fit.order, b.fit.order);
  EXPECT_EQ(a.fit.warnings, b.fit.warnings);
  EXPECT_EQ(a.fit.verdict, b.fit.verdict);
  EXPECT_EQ(a.source.name, b.source.name);
  EXPECT_EQ(a.source.format, b.source.format);
  EXPECT_EQ(a.source.sha256, b.source.sha256);
}

void expect_same(const PerViewBrdf& a, const PerViewBrdf& b) {
  EXPECT_EQ(a.kernel, b.kernel);
  EXPECT_EQ(a.isotropic, b.isotropic);
  EXPECT_EQ(a.align_views, b.align_views);
  EXPECT_EQ(a.default_neighbors, b.default_neighbors);
  EXPECT_EQ(a.views, b.views);
  EXPECT_EQ(a.diffuse, b.diffuse);
  EXPECT_EQ(a.first_lobe, b.first_lobe);
  EXPECT_EQ(a.center, b.center);
  EXPECT_EQ(a.bandwidth, b.bandwidth);
  EXPECT_EQ(a.coefficient, b.coefficient);
}

void expect_same(const ParametricBrdf& a, const ParametricBrdf& b) {
  EXPECT_EQ(a.isotropic, b.isotropic);
  EXPECT_EQ(a.cells, b.cells);
  EXPECT_EQ(a.symmetric, b.symmetric);
  EXPECT_EQ(a.views.begin, b.views.begin);
  EXPECT_EQ(a.views.end, b.views.end);
  EXPECT_EQ(a.space, b.space);
  EXPECT_EQ(a.control, b.control);
}

/// Written, read and written again.
template <typename Brdf>
void expect_round_trip(const Model& model) {
  const auto bytes = encode_model(model);
  const Model again = decode_model(bytes, "memory");
  expect_same_record(model, again);
  expect_same(std::get<Brdf>(model.body), std::get<Brdf>(again.body));
  EXPECT_EQ(encode_model(again), bytes);
}

TEST(ModelFile, RoundTripKeepsEveryBit) {
  for (const Kernel kernel : {Kernel::gaussian, Kernel::abel_poisson}) {
    for (const bool isotropic : {true, false}) {
      expect_round_trip<PerViewBrdf>(example_model(kernel, isotropic));
    }
  }
}

TEST(ModelFile, RoundTripKeepsEveryBitOfParametricModels) {
  for (const bool isotropic : {true, false}) {
    for (const int lobes : {1, 3, 8, ParametricBrdf::kMaxLobes}) {  // 3 would be colors to a viewer
      expect_round_trip<ParametricBrdf>(example_parametric(isotropic, lobes, 4));
    }
  }
}

TEST(ModelFile, ReducedModelsKeepTheirScene) {
  Model model = test::example_reduced();
  expect_round_trip<ParametricBrdf>(model);
  const Model again = decode_model(encode_model(model), "memory");
  ASSERT_TRUE(again.scene);
  EXPECT_EQ(again.scene->domain.view, model.scene->domain.view);
  EXPECT_EQ(again.scene->domain.camera_rays, model.scene->domain.camera_rays);
  EXPECT_EQ(again.scene->domain.frames, 2u);
  EXPECT_EQ(again.scene->domain.light_density, 3.25);
  EXPECT_EQ(again.scene->domain.hash, model.scene->domain.hash);
  EXPECT_EQ(again.scene->picture_error, model.scene->picture_error);
  EXPECT_EQ(again.scene->full_picture_error, model.scene->full_picture_error);
  EXPECT_EQ(again.scene->full_parameter_bytes, 931u);
  model.scene->domain.light_density = std::numeric_limits<double>::infinity();
  EXPECT_EQ(decode_model(encode_model(model), "memory").scene->domain.light_density,
            std::numeric_limits<double>::infinity());
}

TEST(ModelFile, AModelThatNothingSmallerStandsInForIsNotReduced) {
  Model model = test::example_reduced();
  EXPECT_TRUE(is_reduced(model));
  model.scene->full_parameter_bytes = parametric(model).parameter_bytes();
  EXPECT_FALSE(is_reduced(model));
  EXPECT_FALSE(is_reduced(example_parametric()));
  EXPECT_FALSE(is_reduced(example_model()));
}

TEST(ModelFile, SymmetryIsKept) {
  Model model = example_parametric();
  std::get<ParametricBrdf>(model.body).symmetric = true;
  expect_round_trip<ParametricBrdf>(model);
}

TEST(ModelFile, AParametricModelIsBlackWithoutLobes) { expect_round_trip<ParametricBrdf>(example_parametric(true, 0)); }

TEST(ModelFile, ControlValuesMustBeHalfFloats) {
  Model model = example_parametric();
  std::get<ParametricBrdf>(model.body).control[7] = 1.0f / 3.0f;
  EXPECT_THROW(encode_model(model), Error);
}

TEST(ModelFile, TheOrderIsOptionalAndShort) {
  Model model = example_parametric();
  model.fit.order = {};
  expect_round_trip<ParametricBrdf>(model);
  model.fit.order = {{{1, 52, 1.0 / 3.0, 2.0 / 3.0}}, std::nullopt};
  const Model again = decode_model(encode_model(model), "memory");
  EXPECT_EQ(again.fit.order, (OrderCurve{{{1, 52, 0.3333, 0.6667}}, std::nullopt}));
}

TEST(ModelFile, ABlackModelHasNoLobes) {
  Model black = example_model();
  auto& brdf = std::get<PerViewBrdf>(black.body);
  brdf.center.clear();
  brdf.bandwidth.clear();
  brdf.coefficient.clear();
  brdf.diffuse.clear();
  brdf.first_lobe.assign(brdf.views.size() + 1, 0);
  expect_round_trip<PerViewBrdf>(black);
}

TEST(ModelFile, SavesAndLoads) {
  const std::string path = test::scratch_folder() / "metal.velour";
  save_model(example_model(), path);
  EXPECT_TRUE(is_model_file(path));
  expect_same(scattered(load_model(path)), scattered(example_model()));
  expect_same_record(load_model(path), example_model());
}

TEST(ModelFile, OtherFilesAreNoModels) {
  const std::string path = test::scratch_folder() / "other";
  const std::string text = "velour.kind model";
  write_file(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
  EXPECT_FALSE(is_model_file(path));
  EXPECT_THROW(load_model(path), Error);
}

TEST(ModelFile, OverheadIsAFewKilobytes) {
  const Model model = example_model();
  EXPECT_LT(encode_model(model).size(), scattered(model).parameter_bytes() + 5000);
}

TEST(ModelFile, AParametricFileFitsInEightKilobytes) {
  // Eight lobes, eleven nodes: 1064 bytes of parameters; what is left is the record and the headers.
  const Model model = example_parametric(true, 8, 10);
  EXPECT_EQ(parametric(model).parameter_bytes(), 2u * 8 * 11 * 6 + 8);
  EXPECT_LT(encode_model(model).size(), parametric(model).parameter_bytes() + 3000);
  // As many parameters as 2.7 KB hold.
  EXPECT_LT(encode_model(example_parametric(true, 20, 10)).size(), 8000u);
}

TEST(ModelFile, EveryKindHasItsNameAndItsMaterial) {
  for (const auto& [model, kind] : {std::pair(example_model(), "scattered"), {example_parametric(), "parametric"}}) {
    EXPECT_EQ(std::string(model_kind(model)), kind);
    EXPECT_TRUE(make_material(std::make_shared<const Model>(model), 0)->isotropic()) << kind;
  }
}

}  // namespace
}  // namespace velour::model_file_test
