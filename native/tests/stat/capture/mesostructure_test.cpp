// Captures of mesostructure against what geometry and physics demand. Every comparison has a control that must fail.
#include <gtest/gtest.h>

#include <cmath>

#include "support/captured.h"

namespace velour::mesostructure_test {
namespace {

using test::Captured;
using test::small_capture;
using test::tile_of;
using test::ZTests;

std::vector<PolarAngles> some_directions() {
  return {{0, 0}, {20, 10}, {40, 200}, {55, 0}, {60, 130}, {70, 180}, {80, 20}, {85, 100}};
}

/// Share of a face of 45 degrees, from its ridge downwards, that is not hidden from `w` by the opposite ridge: the
/// geometric attenuation of a V-groove [TS67], in the plane across the grooves, where all that counts is w.x / w.z.
double open_share(const Vec3& w) {
  const double x = std::abs(static_cast<double>(w.x)), z = static_cast<double>(w.z);
  return x <= z ? 1 : 2 * z / (z + x);
}

/// Mean of the apparent BRDF of black-bouncing sawtooth() of albedo 1 over a period: each face has 1 / sqrt(2) of area
/// for each unit of the plane, and of it the part that both see reflects. `mask`, `shadow`: with what hides it.
double sawtooth_brdf(const Vec3& wl, const Vec3& wv, bool mask = true, bool shadow = true) {
  double sum = 0;
  for (const float side : {-1.0f, 1.0f}) {
    const Vec3 normal = glm::normalize(Vec3(side, 0, 1));
    const double to_light = std::max(0.0f, glm::dot(normal, wl)), to_viewer = std::max(0.0f, glm::dot(normal, wv));
    const double seen = std::min(mask ? open_share(wv) : 1.0, shadow ? open_share(wl) : 1.0);
    sum += std::sqrt(0.5) * to_light * to_viewer * seen / kPiD;
  }
  return sum / static_cast<double>(wl.z * wv.z);
}

BtfCaptureOptions sharp(std::vector<PolarAngles> views, std::vector<PolarAngles> lights, uint32_t bounces) {
  BtfCaptureOptions options = small_capture(std::move(views), std::move(lights));
  options.sampling.samples = 256;
  options.sampling.bounces = bounces;
  return options;
}

TEST(Mesostructure, SawtoothIsMaskedAndShadowedAsGeometrySays) {
  const auto scene = tile_of(test::sawtooth(), std::make_shared<test::Lambert>(1.0f));
  const auto set = some_directions();
  const Captured captured(*scene, sharp(set, set, 0), "sawtooth");
  const auto list = [&](bool mask, bool shadow) {
    ZTests tests;
    for (size_t p = 0; p < set.size() * set.size(); ++p) {
      const Vec3 wv = unit_direction(set[p / set.size()]), wl = unit_direction(set[p % set.size()]);
      test::Estimate found = captured.mean(p);
      found.error += 2.5e-4 * found.mean;  // rounding to halves, which many texels share
      tests.add(std::to_string(p), found, {sawtooth_brdf(wl, wv, mask, shadow), 0});
    }
    return tests;
  };
  EXPECT_TRUE(list(true, true).agree());
  EXPECT_TRUE(list(false, true).differ()) << "control: no masking";
  EXPECT_TRUE(list(true, false).differ()) << "control: no shadowing";
}

/// Directional albedo by an even set of lights.
double albedo(const Captured& captured, const std::vector<PolarAngles>& lights, size_t view) {
  double sum = 0;
  for (size_t l = 0; l < lights.size(); ++l) {
    sum += captured.mean(view * lights.size() + l).mean * static_cast<double>(unit_direction(lights[l]).z);
  }
  return sum * 2 * kPiD / static_cast<double>(lights.size());
}

TEST(Mesostructure, WhiteSurfacesLoseNothing) {
  const auto scene = tile_of(test::sawtooth(), std::make_shared<test::Lambert>(1.0f));
  const std::vector<PolarAngles> views{{0, 0}, {50, 30}, {75, 170}}, lights = even_directions(250);
  BtfCaptureOptions options = sharp(views, lights, 40);
  options.sampling.samples = 64;
  const Captured all(*scene, options, "energy");
  options.sampling.bounces = 1;
  const Captured one(*scene, options, "energy_one");
  for (size_t v = 0; v < views.size(); ++v) {
    EXPECT_NEAR(albedo(all, lights, v), 1, 0.01) << v;  // mostly the quadrature's
    EXPECT_LT(albedo(one, lights, v), 0.97) << v << " control: one bounce does lose light";
  }
}

TEST(Mesostructure, MeanOverTheTileIsReciprocal) {
  const auto scene = tile_of(test::sawtooth(), std::make_shared<test::Lambert>(0.9f));
  const auto set = some_directions();
  const Captured captured(*scene, sharp(set, set, 3), "reciprocity");
  const auto list = [&](double favour) {
    ZTests tests;
    for (size_t a = 0; a < set.size(); ++a) {
      for (size_t b = 0; b < a; ++b) {
        test::Estimate one = captured.mean(a * set.size() + b);
        one.mean *= favour;
        tests.add(std::to_string(a) + "-" + std::to_string(b), one, captured.mean(b * set.size() + a));
      }
    }
    return tests;
  };
  EXPECT_TRUE(list(1).agree());
  EXPECT_TRUE(list(1.03).differ()) << "control: 3 % one way";
}

/// Bumps of a quarter of the period's height, different along x and y, without any symmetry.
Mesh bumps() {
  constexpr uint32_t kCells = 32;
  std::vector<Vec3> positions;
  std::vector<glm::uvec3> triangles;
  for (uint32_t y = 0; y <= kCells; ++y) {
    for (uint32_t x = 0; x <= kCells; ++x) {
      const float u = static_cast<float>(x) / kCells, v = static_cast<float>(y) / kCells;
      const float z = std::sin(2 * kPi * u) * std::cos(2 * kPi * v) + 0.5f * std::sin(2 * kPi * (2 * u + v));
      positions.push_back({u, v, 0.1f * z});
    }
  }
  for (uint32_t y = 0; y < kCells; ++y) {
    for (uint32_t x = 0; x < kCells; ++x) {
      const uint32_t a = y * (kCells + 1) + x, b = a + kCells + 1;
      triangles.push_back({a, a + 1, b + 1});
      triangles.push_back({a, b + 1, b});
    }
  }
  return Mesh({.positions = positions, .triangles = triangles, .smooth = std::vector<uint8_t>(triangles.size(), 0)});
}

/// Mean square of the differences over their errors, of texel (x, y) with texel (x + dx, y + dy) of the other.
double chi_sq(const Captured& a, const Captured& b, size_t pairs, size_t dx, size_t dy) {
  double sum = 0;
  for (size_t p = 0; p < pairs; ++p) {
    for (size_t t = 0; t < a.texels; ++t) {
      const size_t other = (t / 16 + dy) % 16 * 16 + (t % 16 + dx) % 16;
      const double difference = static_cast<double>(a.green(p, t) - b.green(p, other));
      const double ea = static_cast<double>(a.error(p, t)), eb = static_cast<double>(b.error(p, other));
      sum += difference * difference / (ea * ea + eb * eb + 1e-7);
    }
  }
  return sum / static_cast<double>(pairs * a.texels);
}

TEST(Mesostructure, HasNoSeam) {
  const auto scene = tile_of(bumps(), std::make_shared<test::Lambert>(0.7f));
  const auto set = some_directions();
  BtfCaptureOptions options = small_capture(set, set);
  options.sampling.samples = 64;
  const Captured captured(*scene, options, "seam");
  options.place.origin = {0.5f, 0.25f};
  const Captured shifted(*scene, options, "seam_shifted");
  const size_t pairs = set.size() * set.size();
  EXPECT_LT(chi_sq(shifted, captured, pairs, 8, 4), 1.05);  // stratified: errors are upper bounds
  EXPECT_GT(chi_sq(shifted, captured, pairs, 8, 5), 2) << "control: one texel off";
}

}  // namespace
}  // namespace velour::mesostructure_test
