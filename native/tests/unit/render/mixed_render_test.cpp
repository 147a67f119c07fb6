// Measured materials in mixes, as pictures.
#include <gtest/gtest.h>

#include "brdf/eval/parametric_material.h"
#include "material/shader_layers.h"
#include "math/sphere/random.h"
#include "support/parametric_models.h"
#include "support/proof_materials.h"
#include "support/sided_btfs.h"
#include "support/test_scene.h"

namespace velour::mixed_render_test {
namespace {

using Kind = LayerFactor::Kind;
using Shared = std::shared_ptr<const Material>;

/// A sphere under an uneven sky.
std::vector<float> picture(Shared material) {
  Scene scene;
  scene.add_instance(scene.add_mesh(test::sphere(24)), {},
                     {scene.add_material({std::move(material), Rgb(0.0f), false})});
  std::vector<float> rgb(3 * 32 * 16);
  RandomStream random(3, 3, 3);
  for (float& v : rgb) v = 2 * std::pow(random.next(), 4.0f);
  scene.set_environment(Environment::image({32, 16, 3, rgb}, 1, Mat3(1.0f)));
  scene.set_camera(Camera::look_at({0, -6, 3}, {0, 0, 0}, {0, 0, 1}, 0.5f, 1));
  scene.commit(1);
  return test::rendered(scene, test::small_options(Strategy::srbf));
}

/// `share` of emission, the rest `reflecting` (null: black).
Shared with_emission(float share, Shared reflecting) {
  ShaderLayers layers;
  layers.emissive = {{{2, 1, 0.5f}, {}, {{{Kind::share, share}}}}};
  if (reflecting) layers.reflecting = {{std::move(reflecting), {{{Kind::rest, share}}}}};
  return make_layered_material(layers);
}

/// With half emission mixed in, the picture is the mean of both.
TEST(MixedRender, HalfEmissionGivesTheMeanOfBothPictures) {
  const std::pair<const char*, Shared> kinds[] = {
      {"parametric", make_parametric_material(test::parametric_highlight(100, true))},
      {"per-view", test::highlight_material(100)},
      {"raw measurement", test::measured(test::isotropic_model())},
      {"BTF", test::SrbfKind::material(test::SrbfKind::glossy())}};
  const auto emission = picture(with_emission(1, nullptr));
  for (const auto& [name, material] : kinds) {
    const auto reflected = picture(material), mixed = picture(with_emission(0.5f, material));
    ASSERT_EQ(mixed.size(), emission.size());
    double worst = 0, apart = 0;
    for (size_t i = 0; i < mixed.size(); ++i) {
      const double mean = 0.5 * (static_cast<double>(reflected[i]) + static_cast<double>(emission[i]));
      worst = std::max(worst, std::abs(static_cast<double>(mixed[i]) - mean) / (1 + mean));
      apart = std::max(apart, std::abs(static_cast<double>(mixed[i] - reflected[i])));
    }
    EXPECT_LT(worst, 1e-5) << name;
    EXPECT_GT(apart, 0.1) << name << ": the control";
  }
}

}  // namespace
}  // namespace velour::mixed_render_test
