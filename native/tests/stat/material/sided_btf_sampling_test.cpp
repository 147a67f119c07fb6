// What models of BTFs draw: each sampler against its density, and its samples against quadrature of the value; places,
// levels and views of both sides.
#include "math/sphere/random.h"
#include "math/sphere/warp.h"
#include "support/albedo.h"
#include "support/sided_btfs.h"
#include "support/statistics.h"
#include "support/warped_sampler.h"

namespace velour::sided_btf_sampling_test {
namespace {

using Shared = std::shared_ptr<const Material>;

struct Look {
  const char* name;
  Shared (*glossy)();
  float degrees;
  SurfaceSite site;
};

void PrintTo(const Look& look, std::ostream* out) {
  *out << look.name << ", view " << look.degrees << " degrees, " << (look.site.back ? "behind" : "front")
       << (look.site.footprint == Mat2(0.0f) ? "" : ", from afar");
}

template <typename Kind>
Shared glossy_material() {
  static const Shared material = Kind::material(Kind::glossy());
  return material;
}

std::vector<Look> looks() {
  std::vector<Look> all;
  for (const auto& [name, glossy] : {std::pair<const char*, Shared (*)()>{"srbf", glossy_material<test::SrbfKind>},
                                     {"tensor", glossy_material<test::TensorKind>}}) {
    for (const float degrees : test::kViewAngles) {
      for (const bool back : {false, true}) all.push_back({name, glossy, degrees, {.uv = {0.3f, 0.6f}, .back = back}});
    }
    all.push_back({name, glossy, 45, {.uv = {0.8f, 0.1f}, .footprint = Mat2(0.3f)}});
    all.push_back({name, glossy, 45, SurfaceSite::everywhere()});
  }
  return all;
}

class SidedBtfSampling : public ::testing::TestWithParam<Look> {};

TEST_P(SidedBtfSampling, FollowsItsDensity) {
  const Look& look = GetParam();
  test::expect_proven(test::highlight_sampler(look.glossy(), test::view_at(look.degrees), look.site), look.name);
}

INSTANTIATE_TEST_SUITE_P(All, SidedBtfSampling, ::testing::ValuesIn(looks()));

template <typename Kind>
class SidedBtfDraws : public ::testing::Test {
 protected:
  static const PreparedBrdf& prepared(const Material& material, float degrees, SurfaceSite site) {
    static ScratchArena arena;
    arena.reset();
    return *material.prepare(test::view_at(degrees), site, {}, arena);
  }

  /// Mean of f cos / pdf over samples: the estimator of an even sky. `error` scales the density, for control.
  static test::RunningMean albedo_by_sampling(const PreparedBrdf& point, double error = 1) {
    test::RunningMean mean;
    for (uint64_t i = 0; i < 50'000; ++i) {
      const Vec3 wl = point.sample_one(RandomStream(5, 0, i).next2());
      const auto e = point.eval_one(wl);
      mean.add(wl.z > 0 ? static_cast<double>(e.f.g * wl.z / e.pdf) / error : 0.0);
    }
    return mean;
  }

  static test::Estimate albedo_by_quadrature(const PreparedBrdf& point) {
    const double albedo = test::albedo(point, 100, 400);
    return {albedo, 2e-4 * albedo};  // f has creases where its directions are
  }

  static test::ZTests albedos(double error) {
    const Shared material = glossy_material<Kind>();
    test::ZTests tests;
    for (const float degrees : {0.0f, 45.0f, 75.0f, 89.0f}) {
      for (const bool back : {false, true}) {
        const PreparedBrdf& point = prepared(*material, degrees, {.uv = {0.3f, 0.6f}, .back = back});
        tests.add(std::to_string(degrees) + (back ? " behind" : " front"), albedo_by_sampling(point, error).estimate(),
                  albedo_by_quadrature(point));
      }
    }
    return tests;
  }
};
TYPED_TEST_SUITE(SidedBtfDraws, test::SidedBtfKinds, test::SidedBtfNames);

TYPED_TEST(SidedBtfDraws, EstimateTheAlbedoWithoutBias) {
  const test::ZTests tests = this->albedos(1);
  EXPECT_TRUE(tests.agree());
  EXPECT_LT(tests.smallest_bias(std::to_string(45.0f) + " front"), 0.04);
}

TYPED_TEST(SidedBtfDraws, ControlADensityFivePercentTooHighIsSeen) { EXPECT_TRUE(this->albedos(1.05).differ()); }

/// What the sampler would be were the mixture another: the proof above is not of the cosine alone.
TYPED_TEST(SidedBtfDraws, ControlThePlaceNextToItHasAnotherDensity) {
  const auto at = [](float u, bool back) {
    return test::highlight_sampler(glossy_material<TypeParam>(), test::view_at(45), {.uv = {u, 0.6f}, .back = back});
  };
  EXPECT_GT(test::p_value(at(0.3f, false), at(0.3f, false)), 1e-4);
  EXPECT_LT(test::p_value(at(0.3f, false), at(0.8f, false)), 1e-6);
  EXPECT_LT(test::p_value(at(0.3f, false), at(0.3f, true)), 1e-6);
}

TYPED_TEST(SidedBtfDraws, FollowTheHighlight) {
  const Shared material = glossy_material<TypeParam>();
  const PreparedBrdf& point = this->prepared(*material, 45, {.uv = {0.3f, 0.6f}});
  ProposalLobes lobes;
  ASSERT_TRUE(point.proposal_lobes(lobes));
  EXPECT_EQ(lobes.count, 8);  // seven broad ones and that of the half vector
  EXPECT_LT(lobes.cosine, 0.8f / kPi);
  test::RunningMean cosine;
  for (uint64_t i = 0; i < 50'000; ++i) {
    const Vec3 wl = sample_cosine_hemisphere(RandomStream(5, 0, i).next2());
    cosine.add(static_cast<double>(point.eval_one(wl).f.g) * kPiD);
  }
  EXPECT_LT(this->albedo_by_sampling(point).variance(), 0.5 * cosine.variance());
}

}  // namespace
}  // namespace velour::sided_btf_sampling_test
