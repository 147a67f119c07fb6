#include <gtest/gtest.h>

#include "brdf/eval/parametric_material.h"
#include "brdf/eval/per_view_material.h"
#include "support/materials.h"
#include "support/parametric_models.h"

namespace velour::measured_material_test {
namespace {

/// f = (1, -0.5, 2) where wl.x >= 0, not covered elsewhere.
class HalfCovered final : public Measurement {
 public:
  void eval(const Vec3&, std::span<const Vec3> wl, std::span<Rgb> f, std::span<uint8_t> valid) const override {
    for (size_t i = 0; i < wl.size(); ++i) {
      valid[i] = wl[i].x >= 0 && wl[i].z > 0;
      f[i] = valid[i] ? Rgb(1, -0.5f, 2) : Rgb(7);  // must not be read
    }
  }
  bool isotropic() const override { return false; }
  bool covers_view(float) const override { return true; }
};

using Shared = std::shared_ptr<const Material>;

/// A material of the measurement, and of the model that is its proposal.
std::pair<Shared, Shared> per_view_proposal() {
  const auto proposal = std::make_shared<PerViewBrdf>(test::isotropic_model());
  return {make_measured_material(std::make_shared<HalfCovered>(), proposal, 0), make_per_view_material(proposal, 0)};
}

std::pair<Shared, Shared> parametric_proposal() {
  const auto proposal = std::make_shared<ParametricBrdf>(test::parametric_model(true, test::highlight_recipe(50)));
  return {make_measured_material(std::make_shared<HalfCovered>(), proposal), make_parametric_material(proposal)};
}

class MeasuredMaterial : public testing::TestWithParam<std::pair<Shared, Shared> (*)()> {};
INSTANTIATE_TEST_SUITE_P(Proposals, MeasuredMaterial, testing::Values(&per_view_proposal, &parametric_proposal));

TEST_P(MeasuredMaterial, ClampsChannelsAndIsBlackWhereNothingWasMeasured) {
  const auto [material, model] = GetParam()();
  EXPECT_FALSE(material->isotropic());
  for (const Vec3& wl : sphere_fibonacci(200)) {
    const DirectionPair w{wl, direction(0.6f, 1)};
    const auto e = test::eval_one(*material, w);
    EXPECT_EQ(e.f, wl.x >= 0 && wl.z > 0 ? Rgb(1, 0, 2) : Rgb(0));
    EXPECT_EQ(e.pdf, test::eval_one(*model, w).pdf);
  }
}

TEST_P(MeasuredMaterial, SamplesLikeItsProposal) {
  const auto [material, model] = GetParam()();
  ScratchArena arena;
  const PreparedBrdf* const a = material->prepare(direction(1, 2), arena);
  const PreparedBrdf* const b = model->prepare(direction(1, 2), arena);
  for (const Vec2& u : {Vec2(0, 0), Vec2(0.3f, 0.9f), Vec2(0.99f, 0.5f)}) {
    EXPECT_EQ(a->sample_one(u), b->sample_one(u));
  }
}

}  // namespace
}  // namespace velour::measured_material_test
