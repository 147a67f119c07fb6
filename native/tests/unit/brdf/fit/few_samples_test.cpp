// Scattered measurements of too few samples: refused, or told, and never a model that emits where nothing was measured.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "brdf/fit/per_view/per_view_fit.h"
#include "brdf/formats/cornell.h"
#include "math/sphere/random.h"
#include "math/sphere/warp.h"
#include "support/analytic_measurement.h"
#include "support/warnings.h"

namespace velour::few_samples_test {
namespace {

/// A Cornell file of `count` random samples of a glossy material, at three wavelengths.
std::shared_ptr<const Measurement> cornell_of(int count) {
  const auto glossy = test::ggx(0.2f, 0.2f);
  std::string text = "3\n450 550 650\n";
  RandomStream random(4, 0, 0);
  const auto angles = [&](const Vec3& w) {
    return std::to_string(std::acos(w.z)) + ' ' + std::to_string(std::atan2(w.y, w.x)) + ' ';
  };
  while (count > 0) {
    const Vec3 wl = sample_uniform_hemisphere(random.next2()), wv = sample_uniform_hemisphere(random.next2());
    if (std::min(wl.z, wv.z) < 0.1f) continue;
    const Rgb f = glossy({wl, wv});
    text +=
        angles(wl) + angles(wv) + std::to_string(f.b) + ' ' + std::to_string(f.g) + ' ' + std::to_string(f.r) + '\n';
    --count;
  }
  Provenance provenance;
  provenance.path = "few.brdf";
  return read_cornell({reinterpret_cast<const uint8_t*>(text.data()), text.size()}, provenance);
}

Model fitted(int count, bool all_data = false) {
  FitOptions options;
  options.max_lobes = 6;
  options.all_data = all_data;
  Progress progress;
  return fit_per_view(*cornell_of(count), options, progress);
}

std::string refusal(const auto& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(FewSamples, FourAreRefused) {
  EXPECT_EQ(refusal([] { cornell_of(4); }), "few.brdf: has 4 valid samples; at least 16 are needed to interpolate.");
}

TEST(FewSamples, TooFewToHoldSomeOutAreFittedWholeOrNot) {
  EXPECT_NE(refusal([] { fitted(17); }).find("or fit all data"), std::string::npos);
  const Model model = fitted(17, true);
  EXPECT_TRUE(model.fit.all_data);
}

TEST(FewSamples, AFewDozenAreTold) {
  const Model model = fitted(60);
  const Warning* told = test::find_warning(model.fit.warnings, WarningCode::few_samples);
  ASSERT_NE(told, nullptr);
  EXPECT_EQ(test::value_of<uint64_t>(*told, "samples"), 60u);
  EXPECT_EQ(test::value_of<uint64_t>(*told, "held_out"), 1u);
  EXPECT_LT(model.fit.albedo_max, 10);
}

}  // namespace
}  // namespace velour::few_samples_test
