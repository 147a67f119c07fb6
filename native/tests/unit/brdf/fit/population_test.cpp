// A small population of measurements that no model of ours made, with parameters that nobody tuned on: whatever is
// wrong in the fit's directions, weights, slopes or refinement shows as an error, or as a claim that is not true.
// The large one: scripts/population.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "brdf/fit/fit_model.h"
#include "brdf/measure/held_out.h"
#include "model/file/model_file.h"
#include "model/model.h"
#include "support/hostile_measurements.h"
#include "support/true_error.h"

namespace velour::population_test {
namespace {

using test::AnalyticMeasurement;
using Formula = AnalyticMeasurement::Formula;

struct Member {
  std::string name;
  Formula truth;
  double most;         // error at the reported views up to 75 degrees
  Formula given = {};  // with noise; empty: the truth
  AnalyticMeasurement::Coverage known = {};
};

std::ostream& operator<<(std::ostream& out, const Member& member) { return out << member.name; }

Formula sum(const Formula& a, const Formula& b) {
  return [a, b](const DirectionPair& p) { return a(p) + b(p); };
}

Formula tinted(const Formula& a, const Rgb& tint) {
  return [a, tint](const DirectionPair& p) { return tint * a(p); };
}

/// Schlick's rise of a reflectance of `f0` towards grazing difference angles.
Formula dielectric(const Formula& lobe, float f0) {
  return [lobe, f0](const DirectionPair& p) {
    const float rest = 1 - glm::dot(p.wl, glm::normalize(p.wl + p.wv));
    return (f0 + (1 - f0) * rest * rest * rest * rest * rest) * lobe(p);
  };
}

/// Beckmann facets without masking, over (wl + wv)-z squared so that it stays finite at grazing pairs.
Formula beckmann(float alpha) {
  return [alpha](const DirectionPair& p) {
    const Vec3 h = glm::normalize(p.wl + p.wv);
    const float c = h.z * h.z, d = std::exp((c - 1) / (c * alpha * alpha)) / (kPi * alpha * alpha * c * c);
    const float both = p.wl.z + p.wv.z;
    return Rgb(d / (both * both));
  };
}

/// Oren and Nayar's rough diffuse surface, without interreflection.
Formula oren_nayar(float sigma) {
  return [sigma](const DirectionPair& p) {
    const float s = sigma * sigma, a = 1 - 0.5f * s / (s + 0.33f), b = 0.45f * s / (s + 0.09f);
    const float along = std::max(p.wl.x * p.wv.x + p.wl.y * p.wv.y, 0.0f);
    return Rgb(0.3f, 0.5f, 0.2f) * ((a + b * along / std::max(p.wl.z, p.wv.z)) / kPi);
  };
}

/// Brighter towards the rim, as velvet.
Formula sheen(float power) {
  return [power](const DirectionPair& p) {
    const Vec3 h = glm::normalize(p.wl + p.wv);
    const float sine = std::sqrt(std::max(1 - h.z * h.z, 0.0f));
    return Rgb(0.4f, 0.1f, 0.2f) * (std::pow(sine, power) / (p.wl.z + p.wv.z));
  };
}

std::vector<Member> members() {
  const Formula base = test::lambert;
  const auto away_from_grazing = [](const DirectionPair& p) { return std::min(p.wl.z, p.wv.z) > 0.15f; };
  const Formula paint = sum(base, dielectric(test::ggx(0.17f, 0.17f), 0.04f));
  return {
      {"vinyl", sum(tinted(base, {1.8f, 1.1f, 0.02f}), dielectric(test::ggx(0.011f, 0.011f), 0.045f)), 0.08},
      {"gloss", sum(base, dielectric(test::ggx(0.028f, 0.028f), 0.06f)), 0.06},
      {"metal", test::ggx(0.23f, 0.23f), 0.05},
      {"polished metal", test::ggx(0.06f, 0.06f), 0.05},
      {"Beckmann metal", beckmann(0.21f), 0.05},
      {"paint", paint, 0.05},
      {"Oren-Nayar", oren_nayar(0.6f), 0.05},
      {"velvet", sum(tinted(base, Rgb(0.1f)), sheen(2.5f)), 0.06},
      {"two coats", sum(tinted(test::ggx(0.33f, 0.33f), Rgb(0.5f)), tinted(test::ggx(0.04f, 0.04f), Rgb(0.03f))), 0.06},
      {"retro-reflective", sum(base, tinted(test::retro_reflector(180), Rgb(0.02f))), 0.08},
      {"noise of 8 %", paint, 0.06, test::noisy(paint, 0.08)},
      {"without grazing angles", test::ggx(0.19f, 0.19f), 0.06, {}, away_from_grazing},
  };
}

class Population : public testing::TestWithParam<Member> {};

TEST_P(Population, FitsAreGoodAndSaySo) {
  const Member& member = GetParam();
  AnalyticMeasurement measurement(member.given ? member.given : member.truth);
  if (member.known) measurement.set_coverage(member.known);
  Progress progress;
  const auto model = std::make_shared<const Model>(fit_model(ModelKind::automatic, measurement, {}, progress));
  const auto material = make_material(model, 0);
  for (const int degrees : kHeldOutViews) {
    const auto claimed = model->fit.by_view_angle.at(std::to_string(degrees));
    if (!claimed) continue;
    const Vec3 wv = direction(radians_from(static_cast<float>(degrees)), 0);
    const double real = test::true_error(*material, member.truth, member.known, wv);
    RecordProperty("claimed_" + std::to_string(degrees), std::to_string(*claimed));
    RecordProperty("true_" + std::to_string(degrees), std::to_string(real));
    if (degrees <= 75) {
      EXPECT_LT(real, member.most) << degrees << ", claimed " << *claimed;
    }
    EXPECT_LT(real, 1.2 * *claimed + 0.005) << degrees;
    if (!member.given) {
      EXPECT_GT(real, *claimed / 1.2 - 0.005) << degrees;
    }
  }
}

TEST(FitModel, TheSameFitWritesTheSameBytes) {
  const AnalyticMeasurement measurement(test::ggx(0.3f, 0.3f));
  FitOptions options;
  options.max_lobes = 3;
  Progress progress;
  const auto bytes = [&](int threads) {
    options.threads = threads;
    return encode_model(fit_model(ModelKind::automatic, measurement, options, progress));
  };
  EXPECT_EQ(bytes(1), bytes(2));
}

std::string test_name(const testing::TestParamInfo<Member>& info) {
  std::string name = info.param.name;
  for (char& c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(Small, Population, testing::ValuesIn(members()), test_name);

}  // namespace
}  // namespace velour::population_test
