#include "support/hostile_measurements.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "brdf/measure/brdf_table.h"
#include "math/sphere/random.h"
#include "math/srbf/kernel.h"

namespace velour::test {
namespace {

using Formula = AnalyticMeasurement::Formula;
using Coverage = AnalyticMeasurement::Coverage;

constexpr double kBaseAlbedo = 0.02;

/// A number for the cell of about one degree that the pair lies in.
uint64_t cell_of(const DirectionPair& p) {
  uint64_t key = 0;
  for (const float x : {p.wl.x, p.wl.y, p.wl.z, p.wv.x, p.wv.y, p.wv.z}) {
    key = mix64(key ^ static_cast<uint64_t>(static_cast<int64_t>(std::floor(60 * x)) + 1000));
  }
  return key;
}

/// A Gaussian lobe that counts the same whichever of the two directions is the light.
Rgb reciprocal_lobe(const DirectionPair& p, const Vec3& center, double bandwidth, double albedo) {
  const double peak = albedo / kernel_integral(Kernel::gaussian, bandwidth);
  const double f = peak * kernel_value(Kernel::gaussian, bandwidth, one_minus_dot(Vec3d(p.wl), Vec3d(center)));
  return Rgb(static_cast<float>(f / std::max(p.wl.z, p.wv.z) + kBaseAlbedo / kPiD));
}

/// Diffuse, with one node of a table (29 to 33 degrees of half angle, any view) a thousand times too bright.
Rgb one_bright_node(const DirectionPair& p) {
  const HalfDiff angle = half_diff(p.wl, p.wv);
  const bool inside = std::abs(angle.theta_h - radians_from(31.0f)) < radians_from(2.0f) && angle.phi_d < 0.4f;
  return lambert(p) * (inside ? 1000.0f : 1.0f);
}

/// Highlights at the two ends of the plane of incidence, whatever the view's polar angle.
Rgb opposed_lobes(const DirectionPair& p) {
  const double azimuth = std::atan2(p.wv.y, p.wv.x);
  const Vec3d end(std::cos(azimuth), std::sin(azimuth), 0);
  const auto lobe = [&](const Vec3d& center) {
    return kernel_value(Kernel::gaussian, 20, one_minus_dot(Vec3d(p.wl), center));
  };
  return Rgb(static_cast<float>((lobe(end) + lobe(-end)) / p.wl.z));
}

/// f cos that does not depend on the light at all: a lobe of bandwidth 0.
Rgb constant_radiance(const DirectionPair& p) { return Rgb(0.1f) / p.wl.z; }

/// A saturated color, as a spectral measurement of a laser-like pigment has in Rec. 709.
Rgb outside_gamut(const DirectionPair& p) { return ggx(0.3f, 0.3f)(p) * Rgb(-0.3f, 1.0f, 0.2f); }

/// The albedo is 0.4 at the normal and 1.4 at grazing views.
Rgb too_bright_at_grazing(const DirectionPair& p) { return Rgb((0.4f + 3 * (1 - p.wv.z) * (1 - p.wl.z)) / kPi); }

/// The light side has a cosine too many.
Rgb non_reciprocal(const DirectionPair& p) { return lambert(p) * (0.2f + 1.6f * p.wl.z); }

std::shared_ptr<AnalyticMeasurement> measured(Formula f) { return std::make_shared<AnalyticMeasurement>(std::move(f)); }

std::shared_ptr<AnalyticMeasurement> covered(Formula f, Coverage covers) {
  auto measurement = measured(std::move(f));
  measurement->set_coverage(std::move(covers));
  return measurement;
}

/// `invalid` of every 3 entries are missing, scattered cell by cell.
std::shared_ptr<AnalyticMeasurement> with_invalid_thirds(Formula f, uint64_t invalid) {
  auto measurement = covered(std::move(f), [invalid](const DirectionPair& p) { return cell_of(p) % 3 >= invalid; });
  measurement->set_counts({.total = 300, .valid = 300 - 100 * invalid, .negative = 100 * invalid});
  return measurement;
}

/// What MERL's cameras left: nothing beyond 80 degrees on either side.
bool away_from_grazing(const DirectionPair& p) { return std::min(p.wl.z, p.wv.z) > std::cos(radians_from(80.0f)); }

bool nowhere(const DirectionPair&) { return false; }

bool near_four_lights(const DirectionPair& p) {
  constexpr float kReach = 0.9999f;
  const std::initializer_list<Vec3> lights = {{0, 0, 1}, {0.6f, 0, 0.8f}, {-0.6f, 0, 0.8f}, {0, 0.6f, 0.8f}};
  return std::any_of(lights.begin(), lights.end(), [&](const Vec3& w) { return glm::dot(w, p.wl) > kReach; });
}

HostileCase sound(std::string name, Formula f, std::vector<std::string> told = {}) {
  return {std::move(name), measured(f), f, std::move(told)};
}

HostileCase with_holes(std::string name, const Formula& f, const Coverage& covers, std::vector<std::string> told) {
  return {std::move(name), covered(f, covers), f, std::move(told), "", covers};
}

}  // namespace

Formula near_mirror(double bandwidth) {
  return [bandwidth](const DirectionPair& p) { return reciprocal_lobe(p, {-p.wv.x, -p.wv.y, p.wv.z}, bandwidth, 0.9); };
}

Formula retro_reflector(double bandwidth) {
  return [bandwidth](const DirectionPair& p) { return reciprocal_lobe(p, p.wv, bandwidth, 0.6); };
}

Formula noisy(Formula f, double deviation) {
  return [f = std::move(f), deviation](const DirectionPair& p) {
    RandomStream random(5, cell_of(p), 0);
    const double radius = std::sqrt(-2 * std::log(1 - static_cast<double>(random.next())));
    const double normal = radius * std::cos(2 * kPiD * static_cast<double>(random.next()));
    return f(p) * static_cast<float>(std::max(0.0, 1 + deviation * normal));
  };
}

Formula scaled(Formula f, float by) {
  return [f = std::move(f), by](const DirectionPair& p) { return by * f(p); };
}

std::vector<HostileCase> hostile_cases() {
  const Formula glossy = ggx(0.3f, 0.3f);
  const auto black = [](const DirectionPair&) { return Rgb(0); };
  return {
      sound("near-mirror, bandwidth 1e4", near_mirror(1e4)),
      sound("near-mirror, bandwidth 1e5", near_mirror(1e5)),
      sound("near-mirror, bandwidth 1e6", near_mirror(1e6)),
      {"near-mirror, anisotropic",
       std::make_shared<AnalyticMeasurement>(near_mirror(1e5), false),
       near_mirror(1e5),
       {}},
      sound("perfectly diffuse", lambert),
      sound("black", black, {"black_measurement|black_model"}),
      sound("one bright sample", one_bright_node, {"\"views_exceed_tolerance\""}),
      sound("strong retro-reflection", retro_reflector(1000), {"\"views_exceed_tolerance\""}),
      sound("grazing view", ggx(0.1f, 0.1f)),
      sound("opposed lobes", opposed_lobes, {"not_reciprocal"}),
      sound("bandwidth to 0", constant_radiance, {"not_reciprocal"}),
      sound("coefficients to 0", scaled(glossy, 1e-12f), {"dark_measurement|black_model"}),
      {"all entries invalid", with_invalid_thirds(glossy, 3), glossy, {}, "less than half of the light directions"},
      {"a third of entries invalid", with_invalid_thirds(glossy, 1), glossy, {R"("invalid":100,"entries":300)"}},
      {"noise of 30 %", measured(noisy(glossy, 0.3)), glossy, {"noise_exceeds_tolerance"}},
      sound("scale too large", scaled(glossy, 1500), {"implausible_albedo|dark_measurement|black_model"}),
      sound("scale too small", scaled(glossy, 1 / 1500.0f), {"implausible_albedo|dark_measurement|black_model"}),
      sound("colors outside the gamut", outside_gamut, {"out_of_gamut"}),
      sound("albedo above 1", too_bright_at_grazing, {"albedo_above_one"}),
      sound("non-reciprocal", non_reciprocal, {"not_reciprocal"}),
      with_holes("holes at grazing angles", glossy, away_from_grazing,
                 {R"("views_not_covered","values":\{"views":\[85)", R"("partial_coverage"[^}]*75.0\],"share":0.8)"}),
      with_holes("4 light directions", glossy, near_four_lights, {"no_view_covered"}),
      {"no light direction", covered(glossy, nowhere), glossy, {}, "less than half of the light directions"},
      sound("huge values", scaled(glossy, 1e6f), {"implausible_albedo|dark_measurement|black_model"}),
      {"values that no float squares", measured(scaled(glossy, 1e28f)), glossy, {}, "values up to 1e12"},
      sound("denormals", scaled(glossy, 1e-40f), {"dark_measurement|black_model"}),
  };
}

}  // namespace velour::test
