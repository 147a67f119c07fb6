#include "brdf/fit/closures/closure_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "brdf/fit/closures/closure_curves.h"
#include "brdf/fit/closures/closure_problem.h"
#include "material/material.h"
#include "material/microfacet/ggx_sampler.h"
#include "math/sphere/directions.h"
#include "math/sphere/quadrature.h"

namespace velour {
namespace {

constexpr LobeDistribution kGgx = LobeDistribution::ggx, kBeckmann = LobeDistribution::beckmann;
constexpr LobeMasking kSeparable = LobeMasking::separable, kCorrelated = LobeMasking::height_correlated;

ClosureLobe lobe_of(LobeDistribution distribution, const Rgb& weight, float alpha, float tilt = 0,
                    float anisotropy = 0) {
  ClosureLobe lobe{.distribution = distribution};
  lobe.weight.fill(weight);
  lobe.roughness.fill(std::sqrt(alpha));
  lobe.tilt.fill(tilt);
  lobe.anisotropy.fill(anisotropy);
  return lobe;
}

ClosureNetwork network_of(const Rgb& diffuse, std::vector<ClosureLobe> lobes) {
  ClosureNetwork network;
  network.diffuse.fill(diffuse);
  network.lobes = std::move(lobes);
  return network;
}

ClosureSource source_of(const ClosureNetwork& network, LobeMasking masking) {
  return [=](const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f) {
    const ClosuresAtView view(network, masking, std::atan2(std::hypot(wv.x, wv.y), wv.z));
    for (size_t i = 0; i < wl.size(); ++i) f[i] = wl[i].z > 0 ? view.f_cos(wl[i]) / wl[i].z : Rgb(0);
  };
}

ClosureFit fit_of(const ClosureNetwork& network, const ClosureFitOptions& options) {
  Progress progress;
  return fit_closures(source_of(network, options.masking), true, options, progress);
}

/// Weights, tilt and stretch that vary with the view, within what a spline of the fit represents.
ClosureNetwork varying_network() {
  ClosureNetwork network =
      network_of({0.1f, 0.06f, 0.03f}, {lobe_of(kGgx, Rgb(1), 0.1f), lobe_of(kGgx, Rgb(1), 0.35f)});
  for (size_t i = 0; i < kClosureSamples; ++i) {
    const float x = static_cast<float>(i) / (kClosureSamples - 1), grazing = x * x * x * x;
    ClosureLobe &sharp = network.lobes[0], &wide = network.lobes[1];
    sharp.weight[i] = Rgb(0.3f, 0.25f, 0.2f) + 0.3f * grazing;
    wide.weight[i] = Rgb(0.1f, 0.15f, 0.2f) * (1 - 0.3f * grazing);
    sharp.roughness[i] *= 1 - 0.2f * x * x;
    sharp.anisotropy[i] = -0.4f * x * x;
    wide.anisotropy[i] = 0.3f * x * x;
    wide.tilt[i] = 0.2f * x * x * (3 - 2 * x);
  }
  return network;
}

// Formulas.

double angle_alpha_tan_sq(const Vec3d& w, double ax, double ay) {
  return (ax * ax * w.x * w.x + ay * ay * w.y * w.y) / (w.z * w.z);
}

double plain_lambda(LobeDistribution distribution, double t) {
  if (distribution == kGgx) return 0.5 * (std::sqrt(1 + t) - 1);
  const double a = 1 / std::sqrt(t);
  return a > 1.6 ? 0 : (1 - 1.259 * a + 0.396 * a * a) / (3.535 * a + 2.181 * a * a);
}

/// Cycles' lobe as its source writes it: angles of the frame of the normal N'.
double plain_lobe(LobeDistribution distribution, LobeMasking masking, double ax, double ay, const Vec3d& normal,
                  const Vec3d& wv, const Vec3d& wl) {
  const Vec3d tangent = glm::normalize(wv - glm::dot(wv, normal) * normal), bitangent = glm::cross(normal, tangent);
  const auto local = [&](const Vec3d& w) {
    return Vec3d(glm::dot(w, tangent), glm::dot(w, bitangent), glm::dot(w, normal));
  };
  const Vec3d v = local(wv), l = local(wl), h = glm::normalize(v + l);
  if (l.z <= 0 || v.z <= 0) return 0;
  const double theta = std::acos(h.z), phi = std::atan2(h.y, h.x), tangent_sq = std::tan(theta) * std::tan(theta);
  const double e = tangent_sq * (std::pow(std::cos(phi) / ax, 2) + std::pow(std::sin(phi) / ay, 2));
  const double falloff = distribution == kGgx ? std::pow(1 + e, -2) : std::exp(-e);
  const double d = falloff / (kPiD * ax * ay * std::pow(h.z, 4));
  const double of_v = plain_lambda(distribution, angle_alpha_tan_sq(v, ax, ay));
  const double of_l = plain_lambda(distribution, angle_alpha_tan_sq(l, ax, ay));
  const double g = masking == kSeparable ? 1 / ((1 + of_v) * (1 + of_l)) : 1 / (1 + of_v + of_l);
  return d * g / (4 * v.z);
}

TEST(Closures, ValuesAreThoseOfAPlainImplementation) {
  const double alpha = 0.2, tilt = 0.3, rho = 0.35;
  for (const LobeDistribution distribution : {kGgx, kBeckmann}) {
    for (const LobeMasking masking : {kSeparable, kCorrelated}) {
      const ClosureNetwork network =
          network_of(Rgb(0.3f), {lobe_of(distribution, {0.5f, 1, 2}, static_cast<float>(alpha),
                                         static_cast<float>(tilt), static_cast<float>(rho))});
      for (const float theta_v : {0.1f, 0.7f, 1.4f}) {
        const Vec3 wv = direction(theta_v, 0.8f);
        const double delta = tilt * theta_v;
        const Vec3d normal(std::sin(delta) * std::cos(0.8), std::sin(delta) * std::sin(0.8), std::cos(delta));
        for (const Vec3& wl : hemisphere_fibonacci(200)) {
          const double lobe = plain_lobe(distribution, masking, alpha * std::exp(rho), alpha * std::exp(-rho), normal,
                                         Vec3d(wv), Vec3d(wl));
          const Rgb value = closure_f_cos(network, masking, wv, wl);
          const double diffuse = 0.3 * static_cast<double>(wl.z) / kPiD;
          EXPECT_NEAR(value.r, diffuse + 0.5 * lobe, 1e-3 * (diffuse + lobe));
          EXPECT_NEAR(value.b, diffuse + 2 * lobe, 2e-3 * (diffuse + lobe));
        }
      }
    }
  }
}

TEST(Closures, NothingIsReflectedBelowTheHorizon) {
  const ClosureNetwork network = network_of(Rgb(0.3f), {lobe_of(kGgx, Rgb(1), 0.5f, 0.5f)});
  EXPECT_EQ(closure_f_cos(network, kSeparable, direction(0.5f, 0), direction(1.6f, 1)), Rgb(0));
  EXPECT_EQ(closure_f_cos(network, kSeparable, direction(1.6f, 0), direction(0.5f, 1)), Rgb(0));
}

TEST(Closures, AlbedoOfTheDiffuseLobeIsItsColor) {
  const ClosureNetwork network = network_of({0.1f, 0.5f, 0.9f}, {});
  EXPECT_NEAR(closure_albedo(network, kSeparable, 1.0f, 0), 0.1f, 1e-6f);
  EXPECT_NEAR(closure_albedo(network, kSeparable, 1.0f, 2), 0.9f, 1e-6f);
}

/// Albedo by quadrature over the polar angle and azimuth of the light.
double plain_albedo(const ClosureNetwork& network, LobeMasking masking, float theta_v) {
  const Quadrature z = gauss_legendre(200, 0, 1);
  const ClosuresAtView view(network, masking, theta_v);
  constexpr int kAzimuths = 400;
  double sum = 0;
  for (size_t i = 0; i < z.node.size(); ++i) {
    for (int k = 0; k < kAzimuths; ++k) {
      const auto theta = static_cast<float>(std::acos(z.node[i]));
      sum += z.weight[i] *
             static_cast<double>(view.f_cos(direction(theta, 2 * kPi * (static_cast<float>(k) + 0.5f) / kAzimuths)).g);
    }
  }
  return sum * 2 * kPiD / kAzimuths;
}

TEST(Closures, AlbedoIsTheIntegralOfValues) {
  for (const LobeMasking masking : {kSeparable, kCorrelated}) {
    for (const ClosureLobe& lobe : {lobe_of(kGgx, Rgb(1), 0.3f), lobe_of(kBeckmann, Rgb(1), 0.3f, 0.2f, 0.3f),
                                    lobe_of(kGgx, Rgb(1), 0.5f, -0.05f, -0.4f)}) {
      const ClosureNetwork network = network_of(Rgb(0), {lobe});
      for (const float theta_v : {0.0f, 0.8f, 1.3f}) {
        EXPECT_NEAR(closure_albedo(network, masking, theta_v, 1), plain_albedo(network, masking, theta_v), 0.004);
      }
    }
  }
}

TEST(Closures, AnUntiltedLobeGainsNoEnergy) {
  for (const LobeDistribution distribution : {kGgx, kBeckmann}) {
    for (const float alpha : {0.05f, 0.3f, 1.0f}) {
      const ClosureNetwork network = network_of(Rgb(0), {lobe_of(distribution, Rgb(1), alpha)});
      for (const float theta_v : {0.0f, 0.7f, 1.2f, 1.5f}) {
        const float albedo = closure_albedo(network, kSeparable, theta_v, 0);
        EXPECT_LT(albedo, 1.002f);
        EXPECT_GE(closure_albedo(network, kCorrelated, theta_v, 0), albedo);  // correlated masking hides less
      }
      const float sharp = closure_albedo(network, kSeparable, 0, 0);
      EXPECT_TRUE(alpha > 0.05f || sharp > 0.99f) << sharp;
    }
  }
}

TEST(Closures, DerivativesOfALobeAreThoseOfDifferences) {
  const float theta_v = 1.1f, tilt = 0.1f;
  const Vec3 wl = direction(0.9f, 2.5f), h = glm::normalize(wl + direction(theta_v, 0));
  for (const LobeDistribution distribution : {kGgx, kBeckmann}) {
    for (const LobeMasking masking : {kSeparable, kCorrelated}) {
      const auto sample = [&](float log_x, float log_y, float by) {
        const LobeAtView lobe =
            lobe_at_view(distribution, masking, 0.3f * std::exp(log_x), 0.5f * std::exp(log_y), tilt + by, theta_v);
        return with_lobe_kind(distribution, masking, [&]<LobeDistribution d, LobeMasking m>() {
          return lobe_sample<d, m>(lobe, wl.x, wl.y, wl.z, h.x, h.y, h.z);
        });
      };
      const auto difference = [&](const LobeSample& up, const LobeSample& down) {
        return std::log(up.value / down.value) / 0.02f;
      };
      const LobeSample at = sample(0, 0, 0);
      EXPECT_NEAR(at.by_x, difference(sample(0.01f, 0, 0), sample(-0.01f, 0, 0)), 3e-3f);
      EXPECT_NEAR(at.by_y, difference(sample(0, 0.01f, 0), sample(0, -0.01f, 0)), 3e-3f);
      EXPECT_NEAR(at.by_tilt, difference(sample(0, 0, 0.01f), sample(0, 0, -0.01f)), 1e-2f);
    }
  }
}

TEST(Closures, ShapesStayInsideTheirBounds) {
  const ClosureBounds bounds;
  for (const double u : {-8.0, -1.0, 0.0, 0.5, 8.0}) {
    for (const double theta_v : {0.0, 0.5, 1.3, 1.5}) {
      const ClosureShape s = closure_shape(u, -8, 8, theta_v, bounds);
      EXPECT_GE(s.alpha, bounds.min_alpha);
      EXPECT_LE(s.alpha * std::exp(s.anisotropy), 1 + 1e-9);
      EXPECT_GE(s.tilt * theta_v, static_cast<double>(lowest_closure_tilt(static_cast<float>(theta_v))) - 1e-6);
      EXPECT_LT(closure_shape(u, 8, 0, theta_v, bounds).tilt, 1);
      EXPECT_NEAR(closure_shape(closure_alpha_unknown(0.1, bounds), 0, 0, theta_v, bounds).alpha, 0.1, 1e-9);
      EXPECT_NEAR(closure_shape(0, closure_tilt_unknown(0.3, theta_v, bounds), 0, theta_v, bounds).tilt, 0.3, 1e-9);
    }
  }
  EXPECT_NEAR(lowest_closure_tilt(radians_from(85.0f)), radians_from(-2.2f), radians_from(0.05f));
}

TEST(Closures, TheSlopeOfTheCostIsThatOfDifferences) {
  Progress progress;
  const auto views = closure_samples(source_of(varying_network(), kSeparable), true, 2, progress);
  const ClosureProblem problem(views, {kGgx, kBeckmann}, kSeparable, {}, {.pin_anisotropy = false});
  ClosureUnknowns u(kClosureKnots, 15);
  for (int i = 0; i < u.size(); ++i) u.data()[i] = 0.4 + 0.2 * std::sin(1.7 * i);
  const auto n = problem.normal(u);
  for (int i = 0; i < u.size(); i += 7) {
    ClosureUnknowns up = u, down = u;
    up.data()[i] += 1e-3;
    down.data()[i] -= 1e-3;
    const double difference = (problem.cost(up) - problem.cost(down)) / 4e-3;  // the slope is half the derivative
    EXPECT_NEAR(n.slope[i], difference, 2e-3 * std::abs(difference) + 2e-4 * n.slope.norm()) << i;
  }
}

// Fits.

TEST(ClosureFit, RecoversALobeAndChoosesOne) {
  const ClosureFit fit = fit_of(network_of({0.2f, 0.1f, 0.05f}, {lobe_of(kGgx, {0.4f, 0.5f, 0.6f}, 0.15f)}), {});
  ASSERT_EQ(fit.network.lobes.size(), 1u);
  for (const ClosureViewError& e : fit.errors) EXPECT_LT(e.rgb, 0.01) << e.degrees;
  for (const size_t i : {0u, 20u, 50u}) {
    EXPECT_NEAR(fit.network.lobes[0].roughness[i], std::sqrt(0.15f), 0.01f);
    EXPECT_NEAR(fit.network.lobes[0].weight[i].g, 0.5f, 0.01f);
    EXPECT_NEAR(fit.network.diffuse[i].r, 0.2f, 0.01f);
  }
}

TEST(ClosureFit, RecoversTiltedAndStretchedLobes) {
  for (const LobeMasking masking : {kSeparable, kCorrelated}) {
    const ClosureFit fit = fit_of(varying_network(), {.tolerance = 0.001, .max_lobes = 2, .masking = masking});
    for (const ClosureViewError& e : fit.errors) EXPECT_LT(e.luminance, 0.01) << e.degrees;
  }
}

TEST(ClosureFit, NegativeControlAnotherMaskingIsSeen) {
  Progress progress;
  const ClosureNetwork network = network_of(Rgb(0), {lobe_of(kGgx, Rgb(0.8f), 0.5f)});
  ClosureFit fit = fit_of(network, {.max_lobes = 1});
  const Vec3 wv = direction(1.4f, 0), wl = direction(1.4f, kPi);
  const auto value = [&](LobeMasking masking) { return closure_f_cos(fit.network, masking, wv, wl).g; };
  EXPECT_NEAR(value(kSeparable) / closure_f_cos(network, kSeparable, wv, wl).g, 1, 0.02);
  EXPECT_GT(value(kCorrelated) / closure_f_cos(network, kSeparable, wv, wl).g, 1.1f);
}

TEST(ClosureFit, AlbedoExceedsTheMaterialsByOnePercentAtMost) {
  Progress progress;
  const GgxParameters truth{.alpha = Vec2(0.25f), .f0 = {0.9f, 0.3f, 0.04f}, .f90 = Rgb(1), .diffuse = {0, 0.3f, 0.1f}};
  const auto material = make_ggx_material(truth);
  const ClosureFit fit = fit_closures(*material, {.max_lobes = 1}, progress);
  for (const ClosureAlbedoError& e : fit.albedo) {
    for (int c = 0; c < 3; ++c) EXPECT_LT(e.relative[c], 0.015f) << e.degrees;
  }
  EXPECT_LT(fit.mean_error, 0.1);
}

TEST(ClosureFit, DoesNotDependOnThreads) {
  const ClosureNetwork truth = varying_network();
  const ClosureFit one = fit_of(truth, {.tolerance = 0, .max_lobes = 2, .threads = 1}),
                   four = fit_of(truth, {.tolerance = 0, .max_lobes = 2, .threads = 4});
  EXPECT_EQ(one.network.diffuse, four.network.diffuse);
  ASSERT_EQ(one.network.lobes.size(), four.network.lobes.size());
  for (size_t k = 0; k < one.network.lobes.size(); ++k) {
    EXPECT_EQ(one.network.lobes[k].weight, four.network.lobes[k].weight);
    EXPECT_EQ(one.network.lobes[k].roughness, four.network.lobes[k].roughness);
    EXPECT_EQ(one.network.lobes[k].tilt, four.network.lobes[k].tilt);
    EXPECT_EQ(one.network.lobes[k].anisotropy, four.network.lobes[k].anisotropy);
  }
}

TEST(ClosureFit, PinnedLobesAreRoundAtTheNormal) {
  const ClosureFit fit = fit_of(network_of(Rgb(0), {lobe_of(kGgx, Rgb(0.5f), 0.2f, 0, 0.5f)}), {.max_lobes = 1});
  EXPECT_NEAR(fit.network.lobes[0].anisotropy[0], 0, 1e-6f);
  const ClosureFit freed =
      fit_of(network_of(Rgb(0), {lobe_of(kGgx, Rgb(0.5f), 0.2f, 0, 0.5f)}), {.max_lobes = 1, .pin_anisotropy = false});
  EXPECT_NEAR(freed.network.lobes[0].anisotropy[0], 0.5f, 0.02f);
  EXPECT_LT(freed.mean_error, 0.01);
}

TEST(ClosureFit, BlackMaterialsGiveBlackNetworks) {
  const ClosureFit fit = fit_of(network_of(Rgb(0), {}), {});
  EXPECT_EQ(closure_f_cos(fit.network, kSeparable, direction(0.5f, 0), direction(0.4f, 1)), Rgb(0));
  EXPECT_EQ(fit.mean_error, 0);
}

TEST(ClosureFit, RefusesOptionsOutOfRange) {
  EXPECT_THROW(fit_of(varying_network(), {.max_lobes = 4}), Error);
  EXPECT_THROW(fit_of(varying_network(), {.min_alpha = 0}), Error);
}

TEST(ClosureFit, StopsAtACancel) {
  Progress progress;
  progress.cancel();
  EXPECT_THROW(fit_closures(source_of(varying_network(), kSeparable), true, {}, progress), Error);
}

}  // namespace
}  // namespace velour
