#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "material/ggx.h"
#include "material/principled_material.h"
#include "sphere/directions.h"
#include "support/simd_targets.h"

namespace velour {
namespace {

const PrincipledParameters kMaterials[] = {
    {},
    {.base_color = {0.9f, 0.2f, 0.05f}, .metallic = 1, .roughness = 0.2f, .specular_tint = {0.3f, 1, 0.6f}},
    {.metallic = 0.4f, .roughness = 0.02f, .specular = 0.9f, .coat = 0.7f, .coat_roughness = 0.1f},
    {.base_color = Rgb(0), .specular = 0, .coat = 1},
};

/// All around, more than fill vectors, and not a multiple of them.
DirectionBatch directions() {
  DirectionBatch batch;
  for (const Vec3& d : sphere_fibonacci(53)) batch.push(d);
  batch.pad();
  return batch;
}

TEST(PrincipledKernels, AreTheFormulaOfOneDirectionBitForBitOnEveryTarget) {
  const DirectionBatch batch = directions();
  for (const PrincipledParameters& parameters : kMaterials) {
    const auto material = make_principled_material(parameters);
    const PrincipledLobes lobes(parameters);
    for (const Vec3& wv : hemisphere_fibonacci(12)) {
      PreparedBrdf point;
      material->prepare(wv, point);
      std::optional<ScalarBatch> first;
      test::on_every_simd_target([&] {
        RgbBatch f;
        ScalarBatch pdf;
        material->eval(point, batch, f, pdf);
        for (int i = 0; i < batch.count; ++i) {
          const Vec3 wl = batch.get(i), h = half_vector(wv, wl);
          const Rgb expected = wl.z > 0 ? lobes.value(lobes.parts(lobes.view(wv), wl, h)) : Rgb(0);
          EXPECT_EQ(f.get(i), expected) << i;
          EXPECT_EQ(pdf.v[i], first.value_or(pdf).v[i]) << i;
        }
        first = pdf;
      });
    }
  }
}

}  // namespace
}  // namespace velour
