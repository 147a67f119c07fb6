// What Filter Glossy and Reflective Caustics leave of materials, and which samples count as diffuse light.
#include "material/surface_site.h"

#include <gtest/gtest.h>

#include "material/bsdf_materials.h"
#include "material/normal_map.h"
#include "material/principled/principled_material.h"
#include "material/shader_layers.h"
#include "math/sphere/random.h"
#include "support/materials.h"

namespace velour::lobe_filter_test {
namespace {

const Vec3 kView = direction(0.6f, 1);

/// Valid until the next call.
const PreparedBrdf& point_of(const Material& material, const LobeFilter& filter = {}) {
  static ScratchArena arena;
  arena.reset();
  return *material.prepare(kView, {}, {.filter = filter}, arena);
}

Rgb f_of(const Material& material, const LobeFilter& filter, const Vec3& wl = direction(0.5f, 2)) {
  return test::eval_one(point_of(material, filter), wl).f;
}

PrincipledParameters principled_parameters(PrincipledFormula formula) {
  return {.base_color = Rgb(0.6f, 0.4f, 0.2f),
          .metallic = 0.3f,
          .roughness = 0.4f,
          .coat = 0.5f,
          .coat_tint = Rgb(1),
          .formula = formula};
}

std::shared_ptr<const Material> glossy_layer() { return make_glossy_material({.color = Rgb(0.5f), .roughness = 0.2f}); }
std::shared_ptr<const Material> matte_layer() { return make_rough_diffuse_material({.color = Rgb(0.8f)}); }

/// Half of a mirror's roughness, half diffuse.
std::shared_ptr<const Material> mixed() {
  ShaderLayers layers;
  layers.reflecting = {{glossy_layer(), {{{.value = 0.5f}}}}, {matte_layer(), {{{.value = 0.5f}}}}};
  return make_layered_material(layers);
}

/// Probability with which a mix of two samples the second, from their densities in one direction.
float share_of_second(const Material& mix, const Material& first, const Material& second) {
  const auto density = [](const Material& m) { return test::eval_one(point_of(m), direction(0.5f, 2)).pdf; };
  return (density(mix) - density(first)) / (density(second) - density(first));
}

TEST(LobeFilter, RoughensLobesThatAreSmoother) {
  const auto glossy = [](float roughness) { return make_glossy_material({.roughness = roughness}); };
  // alpha is the square of roughness; single facets have no gain that a rougher surface would change.
  const auto single = [](float roughness) {
    return make_glossy_material({.roughness = roughness, .lobe = GgxLobe::single});
  };
  EXPECT_EQ(f_of(*single(0.2f), {.min_alpha = 0.25f}), f_of(*single(0.5f), {}));
  EXPECT_EQ(f_of(*glossy(0.8f), {.min_alpha = 0.25f}), f_of(*glossy(0.8f), {}));
  const auto metal = [](float roughness, GgxLobe lobe) {
    return make_principled_material({.metallic = 1, .roughness = roughness, .lobe = lobe});
  };
  EXPECT_EQ(f_of(*metal(0.2f, GgxLobe::single), {.min_alpha = 0.25f}), f_of(*metal(0.5f, GgxLobe::single), {}));
  EXPECT_NE(f_of(*metal(0.2f, GgxLobe::single), {.min_alpha = 0.25f}), f_of(*metal(0.2f, GgxLobe::single), {}));
}

TEST(LobeFilter, LeavesDiffuseLightAlone) {
  const LobeFilter filter{.diffuse_only = true};
  EXPECT_EQ(f_of(*make_glossy_material({}), filter), Rgb(0.0f));
  // Cycles takes no light from the base for lobes that are left out, but metal is none of the base.
  const Rgb base = Rgb(0.6f, 0.4f, 0.2f) * (0.7f / kPi);
  EXPECT_LT(
      glm::distance(f_of(*make_principled_material(principled_parameters(PrincipledFormula::layered)), filter), base),
      1e-6f);
  const Rgb layers = f_of(*mixed(), filter);
  EXPECT_LT(glm::distance(layers, Rgb(0.4f / kPi)), 1e-6f);
  const auto matte = make_rough_diffuse_material({.color = Rgb(0.8f), .roughness = 0.5f});
  EXPECT_EQ(f_of(*matte, filter), f_of(*matte, {}));
}

/// In the mean over samples it is the probability of having drawn from the diffuse lobe.
TEST(LobeFilter, DiffuseShareIsThatOfTheDiffuseLobesSamples) {
  const auto mean_share = [](const PreparedBrdf& point) {
    constexpr uint32_t kSamples = 20000;
    double sum = 0, squares = 0;
    for (uint32_t i = 0; i < kSamples; ++i) {
      const Vec3 wl = point.sample_one(RandomStream(1, i, 0).next2());
      const float pdf = test::eval_one(point, wl).pdf;
      const auto share = static_cast<double>(point.diffuse_share(wl, pdf));
      EXPECT_GE(share, 0.0);
      EXPECT_LE(share, 1.0);
      sum += share;
      squares += share * share;
    }
    const double mean = sum / kSamples;
    return std::pair(mean, std::sqrt(std::max(squares / kSamples - mean * mean, 0.0) / kSamples));
  };
  const auto judge = [&](const Material& material, float expected) {
    const auto [mean, error] = mean_share(point_of(material));
    EXPECT_NEAR(mean, static_cast<double>(expected), 4 * error + 1e-6);
    EXPECT_GT(std::abs(mean - static_cast<double>(expected) - 0.05), 4 * error);  // the control: 0.05 is seen
  };
  for (const PrincipledFormula formula : {PrincipledFormula::layered, PrincipledFormula::disney}) {
    judge(*make_principled_material(principled_parameters(formula)),
          PrincipledPoint(principled_parameters(formula), kView).diffuse_end);
  }
  judge(*mixed(), share_of_second(*mixed(), *glossy_layer(), *matte_layer()));
  judge(*make_glossy_material({}), 0.0f);
  judge(*make_rough_diffuse_material({}), 1.0f);
  judge(*make_normal_mapped(mixed(), {}, ReliefPart::lobe), share_of_second(*mixed(), *glossy_layer(), *matte_layer()));
}

}  // namespace
}  // namespace velour::lobe_filter_test
