#include "brdf/measure/microfacet_trend.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "brdf/measure/irregular_samples.h"
#include "material/microfacet/ggx_sampler.h"
#include "measurement_support.h"

namespace velour::microfacet_trend_test {
namespace {

using Brdf = std::function<Rgb(const Vec3& wl, const Vec3& wv)>;

/// Pairs of which half lie within `spread` radians of the mirror direction, as goniometers measure highlights.
std::vector<DirectionPair> pairs(int count, uint64_t seed, float spread = 0.15f) {
  std::vector<DirectionPair> out;
  for (const auto& [wl, wv] : test::random_pairs(count, seed, 0.15f)) {
    Vec3 to = wl;
    if (out.size() % 2 == 0) {
      const Vec3 mirror(-wv.x, -wv.y, wv.z);
      to = glm::normalize(mirror + spread * wl);
    }
    out.push_back({.wl = to.z > 0.05f ? to : wl, .wv = wv});
  }
  return out;
}

std::vector<IrregularSample> measured(const Brdf& brdf, int count, uint64_t seed, float spread = 0.15f) {
  std::vector<IrregularSample> out;
  for (const DirectionPair& pair : pairs(count, seed, spread))
    out.push_back({pair.wl, pair.wv, brdf(pair.wl, pair.wv)});
  return out;
}

/// Relative L2 error of f cos at pairs that were not measured.
double error(const Brdf& found, const Brdf& truth, float spread = 0.15f) {
  double square = 0, whole = 0;
  for (const DirectionPair& pair : pairs(2000, 99, spread)) {
    const Vec3d t(pair.wl.z * truth(pair.wl, pair.wv)), f(pair.wl.z * found(pair.wl, pair.wv));
    square += glm::dot(f - t, f - t);
    whole += glm::dot(t, t);
  }
  return std::sqrt(square / whole);
}

Brdf trend_of(const MicrofacetTrend& trend) {
  return [&trend](const Vec3& wl, const Vec3& wv) { return trend.f(wl, wv); };
}

Brdf ggx(const GgxParameters& parameters) {
  return [parameters](const Vec3& wl, const Vec3& wv) { return ggx_model(parameters, {.wl = wl, .wv = wv}); };
}

const GgxParameters kGlossy{.alpha = Vec2(0.08f), .f0 = Rgb(0.04f), .f90 = Rgb(0.9f), .diffuse = {0.4f, 0.2f, 0.05f}};

TEST(MicrofacetTrend, RecoversGgx) {
  const MicrofacetTrend trend(measured(ggx(kGlossy), 400, 1));
  ASSERT_EQ(trend.shapes().size(), 1u);
  EXPECT_EQ(trend.shapes()[0].tail, 2.0f);
  EXPECT_NEAR(trend.shapes()[0].alpha, 0.08f, 0.001f);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(trend.diffuse()[c], kGlossy.diffuse[c], 0.002f);
  EXPECT_LT(error(trend_of(trend), ggx(kGlossy)), 0.01);
  // Control: another roughness is seen.
  GgxParameters other = kGlossy;
  other.alpha = Vec2(0.084f);
  EXPECT_GT(error(ggx(other), ggx(kGlossy)), 0.02);
}

TEST(MicrofacetTrend, RecoversTwoLobes) {
  const GgxParameters broad{.alpha = Vec2(0.4f), .f0 = Rgb(0.8f, 0.6f, 0.5f), .f90 = Rgb(0.9f), .diffuse = Rgb(0.1f)};
  const Brdf sum = [&](const Vec3& wl, const Vec3& wv) { return ggx(kGlossy)(wl, wv) + ggx(broad)(wl, wv); };
  const auto samples = measured(sum, 800, 2);
  const MicrofacetTrend trend(samples), single(samples, 1);
  EXPECT_EQ(trend.shapes().size(), 2u);
  EXPECT_EQ(single.shapes().size(), 1u);
  EXPECT_LT(error(trend_of(trend), sum), 0.02);
  EXPECT_GT(error(trend_of(single), sum), 0.04);
}

TEST(MicrofacetTrend, HasNoMoreLobesThanItNeeds) {
  const Brdf diffuse = [](const Vec3&, const Vec3&) { return Rgb(0.2f, 0.1f, 0.0f); };
  const MicrofacetTrend trend(measured(diffuse, 200, 3));
  EXPECT_TRUE(trend.shapes().empty());
  EXPECT_LT(error(trend_of(trend), diffuse), 1e-5);
  const MicrofacetTrend black(measured([](const Vec3&, const Vec3&) { return Rgb(0); }, 200, 3));
  EXPECT_EQ(black.f({0, 0, 1}, {0, 0, 1}), Rgb(0));
  EXPECT_EQ(MicrofacetTrend(std::span<const IrregularSample>()).f({0, 0, 1}, {0, 0, 1}), Rgb(0));
}

TEST(IrregularInterpolant, FollowsAHighlightThatSamplesDoNotResolve) {
  GgxParameters narrow = kGlossy;
  narrow.alpha = Vec2(0.02f);
  const IrregularInterpolant interpolant(measured(ggx(narrow), 1200, 4));
  const Brdf found = [&](const Vec3& wl, const Vec3& wv) { return interpolant.f(wl, wv).value_or(Rgb(0)); };
  EXPECT_LT(error(found, ggx(narrow)), 0.03);
}

TEST(IrregularInterpolant, DoesNotFollowALobeThatIsNotThere) {
  // A retro-reflector, which no microfacet lobe follows.
  const Brdf retro = [](const Vec3& wl, const Vec3& wv) {
    return Rgb(0.05f + 2 * std::exp(20 * (glm::dot(wl, wv) - 1)));
  };
  const auto samples = measured(retro, 3000, 5, 0.5f);
  const IrregularInterpolant interpolant(samples);
  const Brdf found = [&](const Vec3& wl, const Vec3& wv) { return interpolant.f(wl, wv).value_or(Rgb(0)); };
  EXPECT_LT(error(found, retro, 0.5f), 0.1);
  EXPECT_GT(error(trend_of(MicrofacetTrend(samples)), retro, 0.5f), 0.3);
}

/// Samples at random directions, none within 12 degrees of the mirror direction of a view at 40 degrees.
std::vector<IrregularSample> without_a_highlight(const Brdf& brdf) {
  constexpr float kGap = radians_from(12.0f);
  std::vector<IrregularSample> out;
  for (const auto& [wl, wv] : test::random_pairs(150, 5, 0.15f)) {
    const HalfDiff angle = half_diff(wl, wv);
    if (angle.theta_h < kGap && std::abs(angle.theta_d - radians_from(40.0f)) < kGap) continue;
    out.push_back({wl, wv, brdf(wl, wv)});
  }
  return out;
}

TEST(IrregularInterpolant, ATrendTellsHighlightsThatNoSampleShows) {
  const Vec3 wl = direction(radians_from(40.0f), 0), wv = direction(radians_from(40.0f), kPi);
  const auto found = IrregularInterpolant(without_a_highlight(ggx(kGlossy))).f(wl, wv);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->g / ggx(kGlossy)(wl, wv).g, 1, 0.25);
  // The control: without a trend, what is far from all samples is not known.
  const Brdf matte = [](const Vec3&, const Vec3&) { return Rgb(0.1f); };
  EXPECT_FALSE(IrregularInterpolant(without_a_highlight(matte)).f(wl, wv));
}

}  // namespace
}  // namespace velour::microfacet_trend_test
