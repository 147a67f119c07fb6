// Scattered samples of brushed surfaces are told from those of plain ones, noisy or glossy as those may be.
#include "brdf/fit/fit_report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "math/sphere/random.h"
#include "measurement_support.h"
#include "support/inputs.h"
#include "support/test_data.h"

namespace velour::azimuth_spread_test {
namespace {

using Brdf = std::function<float(const Vec3&, const Vec3&)>;

/// Gaussian of the half vector's slopes, of widths `across` and `along`, over a diffuse base.
Brdf brushed(float across, float along) {
  return [=](const Vec3& wl, const Vec3& wv) {
    const Vec3 h = glm::normalize(wl + wv);
    const float x = h.x / (h.z * across), y = h.y / (h.z * along);
    return 0.05f + 2.0f * std::exp(-0.5f * (x * x + y * y));
  };
}

std::vector<IrregularSample> samples_of(const Brdf& f, float noise) {
  std::vector<IrregularSample> samples;
  RandomStream random(5, 0, 0);
  for (const auto& [wl, wv] : test::random_pairs(8000, 11, 0.05f)) {
    samples.push_back({wl, wv, Rgb(f(wl, wv) * (1.0f + noise * (random.next() - 0.5f)))});
  }
  return samples;
}

bool is_told(const Brdf& f, float noise) {
  const auto spread = azimuth_spread(samples_of(f, noise));
  return spread && spread->turned > 0.1 && spread->turned > 2 * spread->alike;
}

TEST(AzimuthSpread, TellsBrushedSurfacesFromOthers) {
  EXPECT_TRUE(is_told(brushed(0.15f, 0.45f), 0.0f));
  EXPECT_TRUE(is_told(brushed(0.15f, 0.45f), 0.2f));
  EXPECT_TRUE(is_told(brushed(0.6f, 0.2f), 0.0f));
  for (const float width : {0.1f, 0.3f, 0.8f}) {
    EXPECT_FALSE(is_told(brushed(width, width), 0.0f)) << width;
    EXPECT_FALSE(is_told(brushed(width, width), 1.0f)) << width;
  }
  test::record_input("Cornell .brdf", "samples of an anisotropic surface", "read, with a warning");
}

TEST(AzimuthSpread, FewSamplesDoNotTell) {
  const std::vector<IrregularSample> samples = samples_of(brushed(0.15f, 0.45f), 0.0f);
  EXPECT_FALSE(azimuth_spread(std::span(samples).first(500)).has_value());
}

TEST(AzimuthSpread, TheDatabasesPaintsAreIsotropic) {
  VELOUR_NEED_DATA(path, "brdf/krylon_blue.brdf");
  const auto measurement = load_measurement(path);
  const auto spread = azimuth_spread(measurement->samples());
  EXPECT_TRUE(!spread || spread->turned < std::max(0.1, 2 * spread->alike));
}

}  // namespace
}  // namespace velour::azimuth_spread_test
