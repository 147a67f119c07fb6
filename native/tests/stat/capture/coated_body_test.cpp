// Clear surfaces over pigment and flakes, against closed forms of flat ones and against the light that must come back.
#include "capture/goniometer/coated_body.h"

#include <gtest/gtest.h>

#include <cmath>

#include "capture/goniometer/goniometer.h"
#include "math/sphere/directions.h"

namespace velour::coated_body_test {
namespace {

constexpr double kIor = 1.5;

GoniometerOptions clear_surface(double roughness, const CoatedBody& body) {
  GoniometerOptions options;
  options.surface.roughness = roughness;
  options.body = body;
  options.facets = interface_of(body);
  options.seed = 7;
  options.batches = 8;
  options.tiles_per_batch = 2;
  options.samples_per_tile = 60'000;
  return options;
}

CoatedBody pigment(float albedo) { return {kIor, Reflectance({0.0, 1.0}), 0.2, Rgb(albedo), 1.0}; }

/// Flakes of a metal that reflects everything.
CoatedBody flakes(double roughness) { return {kIor, Reflectance({0.0, 1.0}), roughness, Rgb(0), 0.0}; }

MicrosurfaceBrdf measured(const GoniometerOptions& options) {
  Progress progress;
  const GoniometerBins bins(options);
  GoniometerSums sums(bins);
  for (const GoniometerSums& batch : run_goniometer(options, progress)) sums += batch;
  return {options, bins, sums};
}

double reflected(double cosine) { return fresnel_reflectance({kIor}, cosine); }

/// Mean reflectance of the surface for diffuse light from air.
double mean_reflected() {
  double sum = 0;
  for (int i = 0; i < 1000; ++i) sum += 2 * (i + 0.5) / 1000 * reflected((i + 0.5) / 1000) / 1000;
  return sum;
}

/// f of a flat interface over Lambert's law, without the mirror's reflection (Saunderson's correction, for directions).
double flat_pigment(double albedo, const DirectionPair& pair) {
  const double back_inside = 1 - (1 - mean_reflected()) / (kIor * kIor);
  const double through =
      (1 - reflected(static_cast<double>(pair.wl.z))) * (1 - reflected(static_cast<double>(pair.wv.z)));
  return through * albedo / (kPiD * kIor * kIor * (1 - albedo * back_inside));
}

Vec3d into_medium(const Vec3& w) {
  const Vec3d across(static_cast<double>(w.x) / kIor, static_cast<double>(w.y) / kIor, 0);
  return across + Vec3d(0, 0, std::sqrt(1 - glm::dot(across, across)));
}

/// f of a flat interface over flakes, met once or twice; slopes of two meetings add.
double flat_flakes(double alpha, const DirectionPair& pair) {
  const Vec3d l = into_medium(pair.wl), v = into_medium(pair.wv), h = glm::normalize(l + v);
  const double slope_sq = (h.x * h.x + h.y * h.y) / (h.z * h.z);
  const auto density = [&](double a_sq) { return std::exp(-slope_sq / a_sq) / (kPiD * a_sq); };
  const double mirrored_l = reflected(static_cast<double>(pair.wl.z)),
               mirrored_v = reflected(static_cast<double>(pair.wv.z));
  const double flakes = density(alpha * alpha) + std::sqrt(mirrored_l * mirrored_v) * density(2 * alpha * alpha);
  return (1 - mirrored_l) * (1 - mirrored_v) * flakes / (4 * std::pow(h.z, 4) * l.z * v.z * kIor * kIor);
}

/// Relative L2 distance of `diffuse` from a closed form, over directions up to `widest` radians from the normal.
template <class ClosedForm>
double distance(const MicrosurfaceBrdf& brdf, float widest, const ClosedForm& f) {
  double difference = 0, norm = 0;
  for (const float view : {0.0f, 0.3f, 0.6f, 0.9f}) {
    for (const float light : {0.05f, 0.35f, 0.65f, 1.0f}) {
      for (const float phi : {0.0f, 1.0f, 2.0f, 3.1f}) {
        const DirectionPair pair{direction(widest * light, phi), direction(widest * view, 0)};
        const double expected = f(pair);
        difference += std::pow(static_cast<double>(brdf.diffuse(pair).g) - expected, 2);
        norm += expected * expected;
      }
    }
  }
  return std::sqrt(difference / norm);
}

TEST(CoatedBody, PigmentBelowASmoothSurfaceIsTheClosedFormOfAFlatOne) {
  const MicrosurfaceBrdf brdf = measured(clear_surface(0.02, pigment(0.6f)));
  EXPECT_LT(distance(brdf, 1.0f, [](const auto& pair) { return flat_pigment(0.6, pair); }), 0.02);
  EXPECT_GT(distance(brdf, 1.0f, [](const auto& pair) { return flat_pigment(0.57, pair); }), 0.05)
      << "control: 5 % darker";
}

constexpr float kNarrow = 0.6f;  // further out much comes from flakes after it was totally reflected

TEST(CoatedBody, FlakesBelowASmoothSurfaceAreTheClosedFormOfAFlatOne) {
  const MicrosurfaceBrdf brdf = measured(clear_surface(0.02, flakes(0.15)));
  EXPECT_LT(distance(brdf, kNarrow, [](const auto& pair) { return flat_flakes(0.15, pair); }), 0.06);
  EXPECT_GT(distance(brdf, kNarrow, [](const auto& pair) { return flat_flakes(0.135, pair); }), 0.12)
      << "control: 10 % smoother";
}

TEST(CoatedBody, WhatAbsorbsNothingSendsEverythingBack) {
  const auto expect = [](const GoniometerOptions& options, double tolerance) {
    const MicrosurfaceBrdf brdf = measured(options);
    for (const float view : {0.0f, 45.0f, 70.0f}) {
      const Vec3 wv = direction(radians_from(view), 1.0f);
      EXPECT_NEAR(albedo(brdf, &MicrosurfaceBrdf::f, wv, 10'000).g, 1, tolerance) << view;
    }
  };
  expect(clear_surface(0.4, pigment(1)), 0.01);
  expect(clear_surface(0.05, flakes(0.2)), 0.015);
  const MicrosurfaceBrdf absorbing = measured(clear_surface(0.4, pigment(0.95f)));
  EXPECT_LT(albedo(absorbing, &MicrosurfaceBrdf::f, {0, 0, 1}, 10'000).g, 0.92f) << "control";
}

TEST(CoatedBody, MirrorsAsFresnelsFormulaSays) {
  const MicrosurfaceBrdf brdf = measured(clear_surface(0.1, pigment(0)));
  for (const float view : {0.0f, 60.0f}) {
    const Vec3 wv = direction(radians_from(view), 0);
    const double all = static_cast<double>(albedo(brdf, &MicrosurfaceBrdf::f, wv, 100'000).g);
    EXPECT_NEAR(all / reflected(static_cast<double>(wv.z)), 1, 0.06) << view;
  }
  EXPECT_NEAR(reflected(1), 0.04, 1e-4);
}

}  // namespace
}  // namespace velour::coated_body_test
