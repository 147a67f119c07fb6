#include "capture/conductor.h"

#include <gtest/gtest.h>

#include "capture/microsurface.h"
#include "job/error.h"

namespace velour {
namespace {

TEST(Conductor, NormalIncidenceHasTheTextbookForm) {
  for (const std::string& name : metal_names()) {
    const Conductor c = metal(name);
    const Rgb seen = fresnel_reflectance(c, 1.0f);
    for (int i = 0; i < 3; ++i) {
      const double n = static_cast<double>(c.n[i]), k_sq = static_cast<double>(c.k[i] * c.k[i]);
      EXPECT_NEAR(seen[i], ((n - 1) * (n - 1) + k_sq) / ((n + 1) * (n + 1) + k_sq), 1e-5) << name;
    }
  }
}

TEST(Conductor, ADielectricAtBrewstersAngleReflectsOnePolarisation) {
  // tan theta = 1.5: refracted and reflected rays are perpendicular, r_s = sin(theta_i - theta_t), r_p = 0.
  const double theta = std::atan(1.5), r_s = std::sin(2 * theta - 0.5 * kPiD);
  const Rgb seen = fresnel_reflectance({Rgb(1.5f), Rgb(0)}, static_cast<float>(std::cos(theta)));
  EXPECT_NEAR(seen.r, 0.5 * r_s * r_s, 1e-6);
}

TEST(Conductor, ReflectsEverythingAtGrazingAngles) {
  for (const std::string& name : metal_names()) EXPECT_NEAR(fresnel_reflectance(metal(name), 1e-6f).g, 1, 1e-4) << name;
}

TEST(Conductor, NoRefractiveIndexLosesNothing) {
  for (const float cos_theta : {1.0f, 0.7f, 0.2f, 0.001f}) {
    for (const float k : {0.5f, 1.0f, 4.0f}) {
      EXPECT_NEAR(fresnel_reflectance({Rgb(0), Rgb(k)}, cos_theta).r, 1, 1e-6);
    }
  }
}

TEST(Conductor, GoldIsYellowAndCopperIsRed) {
  for (const char* name : {"gold", "copper"}) {
    const Rgb r = fresnel_reflectance(metal(name), 1.0f);
    EXPECT_GT(r.r, r.g);
    EXPECT_GT(r.g, r.b);
  }
}

TEST(Conductor, AnUnknownNameListsTheKnownOnes) {
  try {
    metal("unobtainium");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::invalid_argument);
    EXPECT_NE(std::string(error.what()).find("unobtainium"), std::string::npos);
    for (const std::string& name : metal_names()) EXPECT_NE(std::string(error.what()).find(name), std::string::npos);
  }
}

}  // namespace
}  // namespace velour
