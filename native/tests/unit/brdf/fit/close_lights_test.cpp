#include "brdf/fit/error/compare.h"

#include <gtest/gtest.h>

#include <cmath>

#include "brdf/eval/per_view_material.h"
#include "math/srbf/kernel.h"
#include "support/materials.h"

namespace velour {
namespace {

std::shared_ptr<const Material> glossy() {
  return make_per_view_material(std::make_shared<const PerViewBrdf>(test::isotropic_model()), 0);
}

double integral(const WeightedLights& lights, const auto& f) {
  double sum = 0;
  for (size_t i = 0; i < lights.wl.size(); ++i) sum += lights.weight[i] * f(lights.wl[i]);
  return sum;
}

TEST(CloseLights, FillTheHemisphere) {
  for (const float theta : {0.0f, 0.1f, 0.8f, 1.3f, 1.55f}) {
    const WeightedLights lights = close_lights(*glossy(), direction(theta, 0.7f));
    EXPECT_NEAR(integral(lights, [](const Vec3&) { return 1.0; }), 2 * kPiD, 0.02 * 2 * kPiD) << theta;
    EXPECT_NEAR(integral(lights, [](const Vec3& w) { return static_cast<double>(w.z); }), kPiD, 0.02 * kPiD) << theta;
  }
}

TEST(CloseLights, SeeLobesOfEveryWidthAboutTheMirrorDirectionAndTheView) {
  for (const float theta : {0.0f, 0.3f, 0.8f, 1.2f}) {
    const Vec3 wv = direction(theta, 0.7f), mirror(-wv.x, -wv.y, wv.z);
    const WeightedLights lights = close_lights(*glossy(), wv);
    for (const double bandwidth : {1e2, 1e3, 1e4, 1e5, 1e6, 1e7}) {
      for (const Vec3& center : {wv, mirror}) {
        const auto lobe = [&](const Vec3& w) {
          return kernel_value(Kernel::gaussian, bandwidth, one_minus_dot(Vec3d(w), Vec3d(center)));
        };
        const double expected = kernel_integral(Kernel::gaussian, bandwidth);
        EXPECT_NEAR(integral(lights, lobe) / expected, 1, 0.03) << theta << ' ' << bandwidth;
      }
    }
  }
}

TEST(CloseLights, SeeTheLobesOfTheMaterialWhereverTheyAre) {
  const Vec3 aside = direction(1.0f, 2.0f);
  PerViewBrdf brdf;
  brdf.views = {{0, 0, 1}};
  brdf.first_lobe = {0, 1};
  brdf.center = {aside};
  brdf.bandwidth = {1e6f};
  brdf.coefficient = {Rgb(1)};
  brdf.isotropic = brdf.align_views = false;
  const auto material = make_per_view_material(std::make_shared<const PerViewBrdf>(brdf), 1);
  const auto lobe = [&](const Vec3& w) {
    return kernel_value(Kernel::gaussian, 1e6, one_minus_dot(Vec3d(w), Vec3d(aside)));
  };
  const double seen = integral(close_lights(*material, {0, 0, 1}), lobe);
  EXPECT_NEAR(seen / kernel_integral(Kernel::gaussian, 1e6), 1, 0.03);
}

}  // namespace
}  // namespace velour
