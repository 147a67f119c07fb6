#include "brdf/measure/spectrum.h"

#include <gtest/gtest.h>

#include <cmath>

#include "measurement_support.h"

namespace velour::spectrum_test {
namespace {

Rgb color_of(const std::vector<double>& wavelengths, const std::function<double(double)>& spectrum) {
  std::vector<float> samples;
  for (const double lambda : wavelengths) samples.push_back(static_cast<float>(spectrum(lambda)));
  return rec709_of(rec709_weights(wavelengths), samples);
}

std::vector<double> range(double first, double last, double step) {
  std::vector<double> values;
  for (double v = first; v <= last; v += step) values.push_back(v);
  return values;
}

TEST(Spectrum, ObserverSumsAsPublished) {  // CIE 15: 21.371 each at 5 nm
  double sum[3] = {0, 0, 0};
  for (const auto& row : kCie1931)
    for (int c = 0; c < 3; ++c) sum[c] += row[c];
  EXPECT_NEAR(sum[0], 21.373, 2e-3);
  EXPECT_NEAR(sum[1], 21.371, 2e-3);
  EXPECT_NEAR(sum[2], 21.379, 3e-3);
  EXPECT_EQ(kCie1931[(555 - kCieFirst) / kCieStep][1], 1.0);
}

TEST(Spectrum, FlatIsWhiteWhateverTheSampling) {
  for (const auto& wavelengths :
       {range(400, 700, 10), range(360, 830, 5), range(350, 1000, 3), std::vector<double>{500}, {420, 433, 690}}) {
    const Rgb white = color_of(wavelengths, [](double) { return 1.0; });
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(white[c], 1.0f, 1e-6f);
  }
}

TEST(Spectrum, LuminanceIsY) {
  // Rec. 709's luminance weights are the second row of its matrix; Bradford moves Y of a color a little, white not.
  const auto wavelengths = range(360, 830, 5);
  const auto reflectance = [](double lambda) { return 0.5 + 0.3 * std::sin(lambda / 60.0); };
  double y = 0, norm = 0;
  for (const auto& row : kCie1931) norm += row[1];
  for (int n = 0; n < kCieCount; ++n) y += kCie1931[n][1] * reflectance(kCieFirst + n * kCieStep) / norm;
  EXPECT_NEAR(double{luminance(color_of(wavelengths, reflectance))}, y, 0.02);
}

TEST(Spectrum, NarrowBandsLieOutsideRec709) {
  const auto band = [](double center) { return [center](double l) { return std::abs(l - center) < 8 ? 1.0 : 0.0; }; };
  const auto wavelengths = range(380, 780, 5);
  const Rgb blue = color_of(wavelengths, band(450)), cyan = color_of(wavelengths, band(500)),
            red = color_of(wavelengths, band(640));
  EXPECT_GT(blue.b, 10 * std::abs(blue.g));
  EXPECT_LT(cyan.r, 0.0f);
  EXPECT_GT(luminance(cyan), 0.0f);
  EXPECT_GT(red.r, 10 * std::abs(red.b));
}

TEST(Spectrum, CoarseSamplingOfASmoothSpectrum) {
  const auto smooth = [](double lambda) { return 0.4 + 0.2 * std::cos(lambda / 80.0); };
  const Rgb fine = color_of(range(360, 830, 1), smooth), coarse = color_of(range(360, 830, 10), smooth);
  EXPECT_LT(glm::length(fine - coarse), 2e-3f);
}

TEST(Spectrum, RefusesBadWavelengths) {
  for (const std::vector<double>& bad :
       {std::vector<double>{}, {500, 400}, {500, 500}, {NAN}, {0.5}, {INFINITY}, {-400}})
    EXPECT_NE(test::refusal([&] { check_wavelengths(bad, "f: wavelengths"); }).find("f: wavelengths"),
              std::string::npos);
}

}  // namespace
}  // namespace velour::spectrum_test
