#include "material/microfacet/ggx_sampler.h"

#include <gtest/gtest.h>

#include "material/microfacet/ggx.h"
#include "math/sphere/directions.h"
#include "math/sphere/warp.h"
#include "support/materials.h"
#include "support/simd_targets.h"

namespace velour::ggx_sampler_test {
namespace {

std::vector<GgxParameters> lobes() {
  return {{.alpha = Vec2(1e-3f), .f0 = Rgb(1), .f90 = Rgb(1)},
          {.alpha = Vec2(0.3f), .f0 = Rgb(0.04f), .f90 = Rgb(1), .diffuse = Rgb(0.5f)},
          {.alpha = {0.1f, 0.6f}, .f0 = {0.9f, 0.5f, 0.1f}, .f90 = Rgb(0.5f), .diffuse = Rgb(0.1f)},
          {.alpha = Vec2(0.5f), .diffuse = Rgb(0.5f)}};
}

std::vector<Vec3> views() { return {{0, 0, 1}, direction(0.8f, 1), direction(1.5f, -2), direction(1.5707f, 3)}; }

float pdf_one(const GgxSampler& sampler, const GgxPoint& point, const Vec3& wl) {
  DirectionBatch batch;
  batch.push(wl);
  batch.pad();
  ScalarBatch pdf;
  sampler.pdf(point, batch, pdf);
  return pdf.v[0];
}

/// Density of the mirrored direction of a visible normal, G1 D / (4 wv.z), in double and as Heitz 2018 writes it.
double reference_reflection(const Vec3& wv, const Vec3& wl, const Vec2& alpha) {
  const Vec3d v(wv), sum = Vec3d(wl) + v, h = glm::normalize(sum);
  if (h.z <= 0) return 0;
  const double ax = static_cast<double>(alpha.x), ay = static_cast<double>(alpha.y);
  const double slope = h.x * h.x / (ax * ax) + h.y * h.y / (ay * ay) + h.z * h.z;
  const double d = 1 / (kPiD * ax * ay * slope * slope);
  const double lambda = 0.5 * (std::sqrt(1 + (ax * ax * v.x * v.x + ay * ay * v.y * v.y) / (v.z * v.z)) - 1);
  return d / (1 + lambda) / (4 * v.z);
}

// On every instruction set: the batch without half vectors against the formula with them.
TEST(GgxSampler, DensityIsTheMixtureOfVisibleNormalsAndCosine) {
  test::on_every_simd_target([] {
    for (const GgxParameters& p : lobes()) {
      const GgxSampler sampler(p);
      for (const Vec3& wv : views()) {
        GgxPoint point;
        sampler.prepare(wv, point);
        for (const Vec3& wl : sphere_fibonacci(400)) {
          const double share = static_cast<double>(point.cosine_share);
          const double expected = share * std::max(static_cast<double>(wl.z), 0.0) / kPiD +
                                  (1 - share) * reference_reflection(wv, wl, p.alpha);
          EXPECT_NEAR(pdf_one(sampler, point, wl), expected, 2e-5 * expected) << p.alpha.x;
        }
        EXPECT_EQ(pdf_one(sampler, point, -wv), 0) << "opposed directions";
      }
    }
  });
}

TEST(GgxSampler, ChoosesByAlbedo) {
  GgxPoint point;
  GgxSampler(lobes()[0]).prepare(views()[1], point);
  EXPECT_FLOAT_EQ(point.cosine_share, 0.05f);  // the defence alone
  GgxSampler(lobes()[3]).prepare(views()[1], point);
  EXPECT_EQ(point.cosine_share, 1);
  GgxSampler({}).prepare(views()[1], point);
  EXPECT_EQ(point.cosine_share, 1);
  const GgxSampler coated(lobes()[1]);
  coated.prepare({0, 0, 1}, point);
  EXPECT_NEAR(point.cosine_share, 0.05f + 0.95f * 0.5f / (0.5f + 0.0353f), 1e-3f);  // 0.88 of f0 is not masked
  const float from_above = point.cosine_share;
  coated.prepare(direction(1.4f, 0), point);
  EXPECT_LT(point.cosine_share, from_above);
}

TEST(GgxSampler, ReachesBothEndsOfTheRandomNumbers) {
  for (const GgxParameters& p : lobes()) {
    const GgxSampler sampler(p);
    for (const Vec3& wv : views()) {
      GgxPoint point;
      sampler.prepare(wv, point);
      for (const Vec2& u : {Vec2(0, 0), Vec2(0.5f), Vec2(1 - 0x1p-24f), Vec2(1 - 0x1p-24f, 0)}) {
        const Vec3 wl = sampler.sample(point, u);
        EXPECT_NEAR(glm::length(wl), 1, 1e-5f);
        if (wl.z > 0) {
          EXPECT_GT(pdf_one(sampler, point, wl), 0);
        }
      }
    }
  }
}

TEST(Ggx, LogSlopeIsTheDerivative) {
  const auto log_f = [](const DirectionPair& w, const Vec2& alpha) {
    return std::log(static_cast<double>(ggx_brdf_without_fresnel(w, glm::normalize(w.wl + w.wv), alpha)));
  };
  for (const Vec2& alpha : {Vec2(0.05f), Vec2(0.5f), Vec2(0.1f, 0.4f), Vec2(1, 0.3f)}) {
    for (const Vec3& wv : {direction(0.1f, 2), direction(1.2f, 0.5f)}) {
      for (const Vec3& wl : hemisphere_fibonacci(40)) {
        const DirectionPair w{.wl = wl, .wv = wv};
        const Vec2 slope = ggx_log_slope(w, glm::normalize(wl + wv), alpha);
        for (int k = 0; k < 2; ++k) {
          constexpr float kStep = 0.01f;
          Vec2 more = alpha, less = alpha;
          more[k] *= std::exp(kStep);
          less[k] *= std::exp(-kStep);
          EXPECT_NEAR(slope[k], (log_f(w, more) - log_f(w, less)) / (2.0 * kStep), 2e-3) << alpha.x << ' ' << k;
        }
      }
    }
  }
}

TEST(Ggx, AnisotropyTurnsWithTheAxes) {
  const Vec2 alpha(0.1f, 0.4f), swapped(0.4f, 0.1f);
  for (const Vec3& h : hemisphere_fibonacci(30)) {
    const Vec3 turned(h.y, h.x, h.z);
    EXPECT_NEAR(ggx_distribution(h, alpha) / ggx_distribution(turned, swapped), 1, 1e-5f);
  }
  EXPECT_GT(ggx_distribution(direction(0.4f, kPi / 2), alpha), 10 * ggx_distribution(direction(0.4f, 0), alpha));
}

TEST(GgxMaterial, ReflectsWhatItsParametersSay) {
  const GgxParameters p = lobes()[2];
  const auto material = make_ggx_material(p);
  EXPECT_FALSE(material->isotropic());
  const DirectionPair w{.wl = direction(0.5f, 2), .wv = direction(0.9f, -1)};
  EXPECT_EQ(test::eval_one(*material, w).f, ggx_model(p, w));
  EXPECT_EQ(test::eval_one(*material, {.wl = direction(1.6f, 2), .wv = w.wv}).f, Rgb(0));
  const Rgb swapped = ggx_model(p, {.wl = w.wv, .wv = w.wl});
  EXPECT_LT(glm::distance(swapped, ggx_model(p, w)), 1e-5f * swapped.r);
}

}  // namespace
}  // namespace velour::ggx_sampler_test
