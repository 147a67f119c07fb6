#include "realtime/lobe_rows.h"

#include <gtest/gtest.h>

#include <random>

#include "base/error.h"
#include "material/principled/principled_material.h"
#include "math/sphere/directions.h"
#include "model/model.h"
#include "realtime/light_map.h"
#include "support/example_srbf.h"
#include "support/level.h"
#include "support/parametric_models.h"
#include "support/sky_lobes.h"
#include "support/table_shader.h"

namespace velour::lobe_rows_test {
namespace {

EnvironmentMixture soft_sky() {
  return test::sky_of({{{0.2f, 0.1f, 1}, 0.7f, Rgb(0.3f, 0.4f, 0.6f)},
                       {{1, -0.5f, 0.8f}, 700, Rgb(200, 180, 120)},
                       {{-1, 0.3f, 0.2f}, 40, Rgb(3, 1, 0.5f)},
                       {{0.3f, 0.9f, 0.1f}, 12, Rgb(0.2f, 0.7f, 0.1f)}});
}

Rgb radiance(const EnvironmentMixture& sky, const Vec3& w) {
  Rgb sum(0.0f);
  for (size_t k = 0; k < sky.size(); ++k) {
    const Vec3 apart = w - sky.center[k];
    sum += std::exp(-sky.bandwidth[k] * 0.5f * glm::dot(apart, apart)) * sky.coefficient[k];
  }
  return sum;
}

/// What `material` reflects of `sky` towards `wv`, by evenly spread light directions: no error of a table.
Vec3d reflected(const Material& material, const EnvironmentMixture& sky, const Frame& frame, const Vec3& wv) {
  static const auto lights = hemisphere_fibonacci(120000);
  ScratchArena arena;
  const PreparedBrdf* const point = material.prepare(frame.to_local(wv), arena);
  Vec3d sum(0.0);
  for (size_t i = 0; i < lights.size(); i += DirectionBatch::kCapacity) {
    DirectionBatch wl;
    for (size_t j = i; j < std::min(lights.size(), i + DirectionBatch::kCapacity); ++j) wl.push(lights[j]);
    wl.pad();
    RgbBatch f;
    ScalarBatch pdf;
    point->eval(wl, f, pdf);
    for (int j = 0; j < wl.count; ++j) {
      const Rgb light = f.get(j) * radiance(sky, frame.to_world(wl.get(j)));
      sum += static_cast<double>(wl.z[j]) * Vec3d(light.r, light.g, light.b);
    }
  }
  return sum * (2 * kPiD / static_cast<double>(lights.size()));
}

/// Relative L2 of what the tables shade, over random surfaces and views up to 80 degrees.
double shading_error(const LobeRows& rows, const Material& material) {
  Progress progress;
  const EnvironmentMixture sky = soft_sky();
  const TablePixels map = light_map(sky, Environment(), 0, progress);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0, 1);
  double error = 0, norm = 0;
  const auto normals = sphere_fibonacci(48);
  for (const Vec3& normal : normals) {
    const Frame frame = Frame::about(normal);
    const float theta = uniform(random) * 80 * kPi / 180, phi = uniform(random) * 2 * kPi;
    const Vec3 wv = frame.to_world({std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
    const Vec3d exact = reflected(material, sky, frame, wv), found(test::shaded(rows, map, frame, wv));
    error += glm::dot(found - exact, found - exact);
    norm += glm::dot(exact, exact);
  }
  return std::sqrt(error / norm);
}

double shading_error(const Model& shown, const Model& model) {
  Progress progress;
  return shading_error(lobe_rows(shown, 0, progress), *make_material(std::make_shared<const Model>(model), 0));
}
double shading_error(const Model& model) { return shading_error(model, model); }
double shading_error(const PrincipledParameters& parameters) {
  Progress progress;
  return shading_error(lobe_rows(parameters, 0, progress), *make_principled_material(parameters));
}

Model of(ModelBody body) { return {.body = std::move(body), .fit = {}, .source = {}}; }

/// Views at every `step` degrees of the meridian, three lobes each.
PerViewBrdf per_view_model(double step) {
  PerViewBrdf brdf;
  brdf.first_lobe = {0};
  for (double degrees = 0; degrees <= 88; degrees += step) {
    const double theta = degrees * kPiD / 180;
    brdf.views.emplace_back(std::sin(theta), 0, std::cos(theta));
    brdf.diffuse.emplace_back(0.1f, 0.05f, 0.02f);
    for (const float bandwidth : {5.0f, 80.0f, 900.0f}) {
      brdf.center.emplace_back(-std::sin(0.9 * theta), 0, std::cos(0.9 * theta));
      brdf.bandwidth.push_back(bandwidth);
      brdf.coefficient.push_back(static_cast<float>(std::cos(theta) / 40) * bandwidth * Rgb(0.9f, 1, 1.1f));
    }
    brdf.first_lobe.push_back(static_cast<uint32_t>(brdf.center.size()));
  }
  return brdf;
}

TEST(LobeRows, ShadeIsotropicModels) {
  for (const float bandwidth : {10.0f, 60.0f, 400.0f, 3000.0f}) {
    const Model model = of(test::parametric_model(true, test::highlight_recipe(bandwidth)));
    EXPECT_LT(shading_error(model), 0.015) << bandwidth;
  }
}

TEST(LobeRows, ShadeAnisotropicModels) {
  for (const float bandwidth : {60.0f, 400.0f}) {
    if (bandwidth < 100 && !test::long_tests()) continue;
    const Model model = of(test::parametric_model(false, test::highlight_recipe(bandwidth)));
    EXPECT_LT(shading_error(model), 0.03) << bandwidth;
  }
}

Model symmetric_model(bool isotropic, float bandwidth) {
  ParametricBrdf brdf = test::parametric_model(isotropic, test::highlight_recipe(bandwidth));
  brdf.symmetric = true;
  return of(brdf);
}

TEST(LobeRows, ShadeSymmetricModels) {
  for (const float bandwidth : {10.0f, 60.0f, 400.0f, 3000.0f}) {
    EXPECT_LT(shading_error(symmetric_model(true, bandwidth)), 0.025) << bandwidth;
  }
}

TEST(LobeRows, ShadeAnisotropicSymmetricModels) {
  EXPECT_LT(shading_error(symmetric_model(false, 400)), 0.03);
  if (!test::long_tests()) return;
  EXPECT_LT(shading_error(symmetric_model(false, 60)), 0.015);
}

/// Without the half of the light's lobes the error is another one.
TEST(LobeRows, BothHalvesOfSymmetricModelsAreSeen) {
  const Model half = of(test::parametric_model(true, test::highlight_recipe(400)));
  EXPECT_GT(shading_error(half, symmetric_model(true, 400)), 0.1);
}

TEST(LobeRows, ShadePerViewModels) { EXPECT_LT(shading_error(of(per_view_model(2))), 0.03); }

/// Coarser: most of the error of the first is at grazing views of its sharp lobes.
TEST(LobeRows, ShadePrincipledMaterials) {
  for (const float metallic : {0.0f, 1.0f}) {
    EXPECT_LT(shading_error({.metallic = metallic, .roughness = 0.2f}), 0.08) << metallic;
    EXPECT_LT(shading_error({.metallic = metallic, .roughness = 0.5f}), 0.03) << metallic;
    EXPECT_LT(shading_error({.metallic = metallic, .roughness = 0.9f}), 0.03) << metallic;
  }
  EXPECT_LT(shading_error({.roughness = 1, .specular = 0}), 0.03);
}

/// What the error is when a highlight is not what it should be: the test would see it.
TEST(LobeRows, ErrorsOfOtherModelsAreSeen) {
  const Model one = of(test::parametric_model(true, test::highlight_recipe(400)));
  const Model other = of(test::parametric_model(true, test::highlight_recipe(60)));
  EXPECT_GT(shading_error(one, other), 0.05);
}

TEST(LobeRows, AreTheSameForAnyNumberOfThreads) {
  const Model model = of(test::parametric_model(true, test::highlight_recipe(60)));
  Progress progress;
  EXPECT_EQ(lobe_rows(model, 1, progress).pixels.rgba, lobe_rows(model, 3, progress).pixels.rgba);
}

TEST(LobeRows, BtfsHaveNone) {
  Progress progress;
  EXPECT_THROW(lobe_rows(of(test::example_srbf()), 1, progress), Error);
}

}  // namespace
}  // namespace velour::lobe_rows_test
