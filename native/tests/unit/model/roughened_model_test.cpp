// Models with wider lobes: what stays, what changes, and by how much.
#include "model/roughened_model.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/error.h"
#include "model/file/model_file.h"
#include "model/model.h"
#include "support/albedo.h"
#include "support/parametric_models.h"
#include "support/proof_materials.h"
#include "support/warnings.h"
#include "unit/model/example_model.h"

namespace velour::roughened_model_test {
namespace {

using test::LobeRecipe;

std::shared_ptr<const Material> material_of(const Model& model) {
  return make_material(std::make_shared<const Model>(model), 0);
}

template <typename Body>
Model model_of(Body body) {
  Model model = test::example_record();
  model.body = std::move(body);
  return model;
}

/// Green of f at a light `degrees` from the mirror direction of a view 30 degrees from the normal, in its plane.
double off_mirror(const Model& model, float degrees) {
  const auto material = material_of(model);
  const float view = radians_from(30.0f);
  const DirectionPair pair{direction(view + radians_from(degrees), kPi), direction(view, 0)};
  return static_cast<double>(test::eval_one(*material, pair).f.g);
}

TEST(RoughenedModel, ByNothingIsTheSameBits) {
  for (const Model& model : {test::example_model(), test::example_parametric(), test::example_btf_model()}) {
    EXPECT_EQ(encode_model(roughened(model, 0)), encode_model(model));
  }
}

TEST(RoughenedModel, RefusesWhatItCannotDo) {
  const Model model = test::example_parametric();
  for (const float bad : {-0.1f, 1.01f, std::numeric_limits<float>::quiet_NaN()}) {
    EXPECT_THROW(roughened(model, bad), Error) << bad;
  }
  for (const Model& btf : {test::example_btf_model(), test::example_srbf_model(), test::example_tensor_model()}) {
    try {
      roughened(btf, 0.5f);
      FAIL() << "a BTF was made rougher";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("Set the roughness offset to 0"), std::string::npos);
    }
  }
}

TEST(RoughenedModel, SaysSoAndIsAFileLikeAnyOther) {
  const Model rougher = roughened(test::example_parametric(false), 0.25f);
  EXPECT_EQ(rougher.fit.warnings.back(), warning<WarningCode::roughened>({{"roughness", 0.25}}));
  const Model again = decode_model(encode_model(rougher), "again");
  EXPECT_EQ(std::get<ParametricBrdf>(again.body).control.size(), std::get<ParametricBrdf>(rougher.body).control.size());
}

/// A mirror in all but name; its lobe is in half space or about each view's mirror direction.
std::vector<Model> mirrors() {
  const LobeRecipe half{LobeSpace::half, 1e6f, Rgb(1e4f)};
  return {model_of(test::parametric_model(true, {half})), model_of(test::parametric_model(false, {half}, 4)),
          model_of(test::highlight_model(Kernel::gaussian, 1e6f, test::meridian_views(), true))};
}

TEST(RoughenedModel, AMirrorGetsTheWidthOfItsAlpha) {
  for (const Model& mirror : mirrors()) {
    for (const float roughness : {0.2f, 0.3f, 0.4f}) {
      const Model rougher = roughened(mirror, roughness);
      const double alpha = static_cast<double>(roughness * roughness);
      // A half vector turns by half of what the light does, and is exp(-1) of the peak where it is alpha from it. f cos
      // of the scattered model is round, with the area of the half vectors': 7 % less in the plane at 30 degrees.
      const auto away = static_cast<float>(2 * alpha * 180 / kPiD);
      EXPECT_NEAR(off_mirror(rougher, away) / off_mirror(rougher, 0), std::exp(-1), 0.1) << roughness;
      EXPECT_LT(off_mirror(mirror, away) / off_mirror(mirror, 0), 1e-4);
    }
  }
}

/// Views between those of the splines' nodes as well.
const std::vector<float> kViews = {0, 3, 11, 17, 25, 33, 45, 57, 66, 72, 79, 83, 87};

/// The largest that an albedo rises and falls to, over what it was.
struct Change {
  double most = 0, least = 1e30;
};

Change albedo_change(const Model& model, float roughness) {
  const auto before = material_of(model), after = material_of(roughened(model, roughness));
  Change change;
  for (const float degrees : kViews) {
    const Vec3 wv = direction(radians_from(degrees), 0.4f);
    const double ratio = test::albedo(*after, wv, 300, 240) / test::albedo(*before, wv, 300, 240);
    change.most = std::max(change.most, ratio);
    change.least = std::min(change.least, ratio);
  }
  return change;
}

/// What splines and slices of few views leave; the furthest are those beyond the last view of a scattered model.
struct Bound {
  float roughness;
  double change;
};
constexpr Bound kBounds[] = {{0.1f, 0.01}, {0.3f, 0.01}, {0.6f, 0.03}, {1, 0.065}};

class RoughenedLight : public ::testing::TestWithParam<Model> {};

TEST_P(RoughenedLight, IsKept) {
  for (const auto& [roughness, bound] : kBounds) {
    const Change change = albedo_change(GetParam(), roughness);
    EXPECT_LT(change.most, 1 + bound) << roughness;
    EXPECT_GT(change.least, 1 - bound) << roughness;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Models, RoughenedLight,
    ::testing::Values(model_of(test::parametric_model(true, test::highlight_recipe(200))),
                      model_of(test::parametric_model(false, test::highlight_recipe(60), 8)),
                      model_of(test::parametric_model(true, test::fading_recipe(30))),
                      model_of(test::highlight_model(Kernel::gaussian, 200, test::meridian_views(), true)),
                      model_of(test::highlight_model(Kernel::abel_poisson, 0.8f, test::meridian_views(), true))));

TEST(RoughenedModel, IsWiderTheRougherItIs) {
  for (const Model& model : mirrors()) {
    double last = off_mirror(model, 0);
    for (const float roughness : {0.05f, 0.1f, 0.2f, 0.3f, 0.45f, 0.6f, 0.8f, 1.0f}) {
      const double peak = off_mirror(roughened(model, roughness), 0);
      EXPECT_LT(peak, last) << roughness;
      last = peak;
    }
  }
}

}  // namespace
}  // namespace velour::roughened_model_test
