// Samples of materials that let light through: their density over the whole sphere, and what they bring.
#include "math/sphere/quadrature.h"
#include "math/sphere/random.h"
#include "support/proof_materials.h"
#include "support/statistics.h"
#include "support/through_btfs.h"

namespace velour::through_sampling_test {
namespace {

template <typename Kind>
class ThroughSampling : public ::testing::Test {
 protected:
  static const ThroughMaterial& material() {
    static const auto of = test::through_material<Kind>(test::with_through(Kind::glossy()));
    return *of;
  }
  static std::shared_ptr<const Material> shared() { return {std::shared_ptr<void>(), &material()}; }

  static test::Sampler sampler(float degrees, bool back) {
    test::Sampler of = test::material_sampler(shared(), test::view_at(degrees), {.uv = {0.3f, 0.6f}, .back = back});
    of.may_fail = true;
    return of;
  }

  /// Mean of f |cos| / pdf over samples: the estimator under even light from everywhere. `error`, for control, scales
  /// the density of those that go through.
  static test::RunningMean by_sampling(const PreparedBrdf& point, double error) {
    test::RunningMean mean;
    for (uint64_t i = 0; i < 50'000; ++i) {
      const Vec3 wl = point.sample_one(RandomStream(5, 0, i).next2());
      if (wl == Vec3(0.0f)) {
        mean.add(0);
        continue;
      }
      const auto e = point.eval_one(wl);
      mean.add(static_cast<double>(e.f.g * std::abs(wl.z) / e.pdf) / (wl.z < 0 ? error : 1.0));
    }
    return mean;
  }

  static test::Estimate by_quadrature(const PreparedBrdf& point) {
    const Quadrature z = gauss_legendre(100, 0, 1);
    constexpr int kTurns = 400;
    double sum = 0;
    for (size_t i = 0; i < z.node.size(); ++i) {
      const double r = std::sqrt(1 - z.node[i] * z.node[i]);
      for (int k = 0; k < 2 * kTurns; ++k) {
        const double phi = 2 * kPiD * (k + 0.5) / kTurns, height = k < kTurns ? z.node[i] : -z.node[i];
        const Vec3 wl(r * std::cos(phi), r * std::sin(phi), height);
        sum += z.weight[i] * z.node[i] * static_cast<double>(point.eval_one(wl).f.g);
      }
    }
    const double albedo = sum * 2 * kPiD / kTurns;
    return {albedo, 2e-4 * albedo};  // f has creases where its directions are
  }

  static test::ZTests estimates(double error) {
    test::ZTests tests;
    ScratchArena arena;
    for (const float degrees : {0.0f, 45.0f, 75.0f, 89.0f}) {
      for (const bool back : {false, true}) {
        arena.reset();
        const PreparedBrdf* const point =
            material().prepare(test::view_at(degrees), {.uv = {0.3f, 0.6f}, .back = back}, {}, arena);
        tests.add(std::to_string(degrees) + (back ? " behind" : " front"), by_sampling(*point, error).estimate(),
                  by_quadrature(*point));
      }
    }
    return tests;
  }
};
TYPED_TEST_SUITE(ThroughSampling, test::SidedBtfKinds, test::SidedBtfNames);

TYPED_TEST(ThroughSampling, FollowsItsDensityOnBothSides) {
  for (const float degrees : test::kViewAngles) {
    for (const bool back : {false, true}) {
      EXPECT_GT(test::p_value(this->sampler(degrees, back), this->sampler(degrees, back)), 1e-5)
          << degrees << " degrees, " << (back ? "behind" : "front");
    }
  }
}

TYPED_TEST(ThroughSampling, ControlAnotherFaceHasAnotherDensity) {
  EXPECT_LT(test::p_value(this->sampler(45, false), this->sampler(45, true)), 1e-6);
}

TYPED_TEST(ThroughSampling, EstimatesTheLightOfBothSidesWithoutBias) {
  const test::ZTests tests = this->estimates(1);
  EXPECT_TRUE(tests.agree());
  EXPECT_LT(tests.smallest_bias(std::to_string(45.0f) + " front"), 0.04);
}

TYPED_TEST(ThroughSampling, ControlADensityFivePercentTooHighBeyondIsSeen) {
  EXPECT_TRUE(this->estimates(1.05).differ());
}

/// A share that no side is left without, larger where more comes through.
TYPED_TEST(ThroughSampling, ShareIsThatOfTheLight) {
  EXPECT_GT(this->material().share(false), ThroughMaterial::kMinShare);
  EXPECT_LT(this->material().share(false), 1 - ThroughMaterial::kMinShare);
  EXPECT_NEAR(this->material().share(false) + this->material().share(true), 1, 0.02);
}

}  // namespace
}  // namespace velour::through_sampling_test
