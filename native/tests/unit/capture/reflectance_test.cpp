#include "capture/goniometer/coated_body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <complex>

#include "base/error.h"
#include "capture/goniometer/microsurface.h"

namespace velour::reflectance_test {
namespace {

/// Fresnel's formulas by complex numbers.
double textbook(const RefractiveIndex& index, double cos_theta) {
  const std::complex<double> m(index.n, index.k), inside = std::sqrt(m * m - (1.0 - cos_theta * cos_theta));
  const double s = std::norm((cos_theta - inside) / (cos_theta + inside));
  const double p = std::norm((m * m * cos_theta - inside) / (m * m * cos_theta + inside));
  return 0.5 * (s + p);
}

constexpr RefractiveIndex kIndices[] = {{0.05, 4.0}, {0.2, 3.3}, {1.3, 1.8}, {3.2, 3.3}, {2.7, 8.3}, {1.5, 0.0}};

TEST(Reflectance, IsFresnelsFormulaWhateverTheIndex) {
  for (const RefractiveIndex& index : kIndices) {
    for (int i = 0; i <= 20; ++i) {
      EXPECT_NEAR(fresnel_reflectance(index, 0.05 * i), textbook(index, 0.05 * i), 1e-12) << index.n << " " << i;
    }
  }
}

TEST(Reflectance, ADielectricAtBrewstersAngleReflectsOnePolarisation) {
  // tan theta = 1.5: refracted and reflected rays are perpendicular, r_s = sin(theta_i - theta_t), r_p = 0.
  const double theta = std::atan(1.5), r_s = std::sin(2 * theta - 0.5 * kPiD);
  EXPECT_NEAR(fresnel_reflectance({1.5}, std::cos(theta)), 0.5 * r_s * r_s, 1e-12);
}

TEST(Reflectance, NoRefractiveIndexLosesNothing) {
  for (const double cos_theta : {1.0, 0.7, 0.2, 0.001}) {
    for (const double k : {0.5, 1.0, 4.0}) EXPECT_EQ(fresnel_reflectance({0.0, k}, cos_theta), 1) << k;
  }
}

TEST(Reflectance, TheTableIsTheFormulaBetweenItsNodesToo) {
  for (const RefractiveIndex& index : kIndices) {
    const Reflectance table(index);
    for (int i = 0; i <= 5000; ++i) {
      const double cosine = i / 5000.0;
      const Rgb seen = table.at(static_cast<float>(cosine));
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(seen[c], textbook(index, cosine), 1e-4) << index.n << " " << cosine;
    }
    EXPECT_EQ(table.at(-0.1f), table.at(0.0f));
    EXPECT_EQ(table.at(1.1f), table.at(1.0f));
  }
}

TEST(Reflectance, TheSpectrumIsSeenNotThreeWavelengths) {
  // A step from nothing to everything at 550 nm, as an index of 1 and of 0: orange.
  const double wavelengths[] = {549.0, 551.0};
  const RefractiveIndex indices[] = {{1.0, 0.0}, {0.0, 1.0}};
  const Rgb seen = Reflectance(wavelengths, indices).at(1.0f);
  EXPECT_EQ(seen.r, 1);               // 1.4 before it is held
  EXPECT_EQ(seen.b, 0);               // -0.08
  EXPECT_NEAR(seen.g, 0.385, 0.001);  // the observer's table, summed apart
}

double largest_difference(const Rgb& a, const Rgb& b) {
  return static_cast<double>(std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)}));
}

TEST(Metals, AreOfTheirPublishedColors) {
  // [AHH18 Table 9.2], of other samples: published reflectances of one metal differ by some hundredths, those of
  // titanium and iron, whose films corrode, by a tenth.
  const struct {
    const char* name;
    Rgb published;
    double bound;
  } metals[] = {
      {"gold", {1.0f, 0.782f, 0.344f}, 0.05},      {"copper", {0.955f, 0.638f, 0.538f}, 0.05},
      {"silver", {0.972f, 0.960f, 0.915f}, 0.07},  {"aluminium", {0.913f, 0.922f, 0.924f}, 0.05},
      {"nickel", {0.660f, 0.609f, 0.526f}, 0.05},  {"chromium", {0.549f, 0.556f, 0.554f}, 0.05},
      {"titanium", {0.542f, 0.497f, 0.449f}, 0.1}, {"iron", {0.562f, 0.565f, 0.578f}, 0.1},
      {"brass", {0.910f, 0.778f, 0.423f}, 0.1},
  };
  for (const auto& metal : metals) {
    const Rgb seen = metal_reflectance(metal.name).at(1.0f);
    EXPECT_LT(largest_difference(seen, metal.published), metal.bound) << metal.name;
  }
  EXPECT_EQ(metal_names().size(), std::size(metals));
  // Control: gold at 617, 549 and 471 nm is pale.
  const Rgb pale{0.931f, 0.787f, 0.401f};
  EXPECT_GT(largest_difference(pale, metals[0].published), metals[0].bound);
}

TEST(Metals, ReflectEverythingAtGrazingAngles) {
  for (const std::string& name : metal_names()) {
    EXPECT_LT(largest_difference(metal_reflectance(name).at(0.0f), Rgb(1)), 1e-6) << name;
  }
}

TEST(Metals, ReflectLessBelowAMediumThatIsMoreLikeThem) {
  for (const std::string& name : metal_names()) {
    EXPECT_LT(luminance(metal_reflectance(name, 1.5).at(1.0f)), luminance(metal_reflectance(name).at(1.0f))) << name;
  }
}

TEST(Metals, AnUnknownNameListsTheKnownOnes) {
  try {
    metal_reflectance("unobtainium");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::invalid_argument);
    EXPECT_NE(std::string(error.what()).find("unobtainium"), std::string::npos);
    for (const std::string& name : metal_names()) EXPECT_NE(std::string(error.what()).find(name), std::string::npos);
  }
}

}  // namespace
}  // namespace velour::reflectance_test
