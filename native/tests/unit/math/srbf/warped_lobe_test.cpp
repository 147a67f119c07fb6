#include "math/srbf/warped_lobe.h"

#include <gtest/gtest.h>

#include <cmath>

#include "math/srbf/kernel.h"

namespace velour::warped_lobe_test {
namespace {

constexpr double kStep = 1e-6;

Vec3d direction_d(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

WarpedLobe lobe_of(LobeSpace space) {
  return {space, stretch_from(0.4, -0.3), tilted_normal(0.2, -0.1), 7.0, Vec3d(1)};
}

class WarpedLobeSpaces : public testing::TestWithParam<LobeSpace> {};

TEST_P(WarpedLobeSpaces, UnwarpingUndoesTheWarp) {
  const WarpedLobe lobe = lobe_of(GetParam());
  const Vec3d wv = direction_d(1.2, 0.4);
  for (const double theta : {0.0, 0.5, 1.1, 1.5}) {
    for (const double phi : {0.0, 1.0, 3.0, 5.0}) {
      const Vec3d wl = direction_d(theta, phi);
      const auto back = unwarped(lobe, warped(lobe, wl, wv), wv);
      ASSERT_TRUE(back);
      EXPECT_NEAR(glm::length(*back - wl), 0, 1e-12);
    }
  }
}

/// The area that psi sweeps for two small steps of wl, over the steps' own.
double swept(const WarpedLobe& lobe, const Vec3d& wl, const Vec3d& wv) {
  const Vec3d x = glm::normalize(glm::cross(wl, Vec3d(0.3, 0.2, 0.9))), y = glm::cross(wl, x);
  const auto slope = [&](const Vec3d& t) {
    return (warped(lobe, glm::normalize(wl + kStep * t), wv) - warped(lobe, glm::normalize(wl - kStep * t), wv)) /
           (2 * kStep);
  };
  return glm::length(glm::cross(slope(x), slope(y)));
}

TEST_P(WarpedLobeSpaces, TheJacobianIsTheRatioOfSolidAngles) {
  const WarpedLobe lobe = lobe_of(GetParam());
  for (const double theta_v : {0.1, 0.8, 1.5}) {
    const Vec3d wv = direction_d(theta_v, 2.0);
    for (const double theta : {0.05, 0.7, 1.4}) {
      const Vec3d wl = direction_d(theta, 4.0);
      const double jacobian = warp_jacobian(lobe, wl, wv);
      EXPECT_NEAR(swept(lobe, wl, wv), jacobian, 1e-6 * jacobian);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Spaces, WarpedLobeSpaces, testing::Values(LobeSpace::light, LobeSpace::half));

TEST(WarpedLobe, WithoutStretchAHalfLobeHasTheHalfVectorsJacobian) {
  const WarpedLobe lobe{LobeSpace::half, {}, {0, 0, 1}, 1, Vec3d(1)};
  const Vec3d wl = direction_d(0.9, 1), wv = direction_d(1.3, 3);
  const Vec3d h = glm::normalize(wl + wv);
  EXPECT_NEAR(warp_jacobian(lobe, wl, wv), 1 / (4 * glm::dot(wv, h)), 1e-12);
}

TEST(WarpedLobe, HalfVectorsThatFaceAwayHaveNoLight) {
  const WarpedLobe lobe{LobeSpace::half, {}, {0, 0, 1}, 1, Vec3d(1)};
  EXPECT_FALSE(unwarped(lobe, {-1, 0, 0}, direction_d(1.2, 0)));
}

TEST(WarpedLobe, AnUnstretchedLightLobeIsAPlainOne) {
  const WarpedLobe lobe{LobeSpace::light, {}, tilted_normal(0.5, 0.2), 12, Vec3d(1)};
  const Vec3d wl = direction_d(0.3, 2), wv = direction_d(1, 0);
  EXPECT_NEAR(warped_kernel(lobe, wl, wv), kernel_value(Kernel::gaussian, 12, one_minus_dot(wl, lobe.center)), 1e-12);
  EXPECT_NEAR(warp_jacobian(lobe, wl, wv), 1, 1e-12);
}

TEST(Stretch, KeepsTheAreaAndItsAxis) {
  for (const double a : {-1.0, 0.0, 0.6}) {
    for (const double b : {0.0, 1e-9, 0.8}) {
      const Stretch s = stretch_from(a, b);
      EXPECT_NEAR(s.xx * s.yy - s.xy * s.xy, 1, 1e-12);
    }
  }
  EXPECT_NEAR(stretch_from(0.6, 0).xx, std::exp(-0.6), 1e-12);
  EXPECT_NEAR(stretch_from(0.6, 0).yy, std::exp(0.6), 1e-12);
}

TEST(Stretch, SlopesAreDerivatives) {
  for (const double a : {0.0, 1e-5, 0.7, -1.5}) {
    for (const double b : {0.0, 0.3}) {
      const StretchSlopes slopes = stretch_slopes(a, b);
      const auto compare = [](const Stretch& up, const Stretch& down, const Stretch& slope) {
        EXPECT_NEAR((up.xx - down.xx) / (2 * kStep), slope.xx, 1e-7);
        EXPECT_NEAR((up.xy - down.xy) / (2 * kStep), slope.xy, 1e-7);
        EXPECT_NEAR((up.yy - down.yy) / (2 * kStep), slope.yy, 1e-7);
      };
      compare(stretch_from(a + kStep, b), stretch_from(a - kStep, b), slopes.by_a);
      compare(stretch_from(a, b + kStep), stretch_from(a, b - kStep), slopes.by_b);
    }
  }
}

TEST(Tilt, SlopesAreDerivatives) {
  for (const double x : {0.0, 1e-5, 0.7, -1.5}) {
    for (const double y : {0.0, 0.3}) {
      const TiltSlopes slopes = tilt_slopes(x, y);
      const auto slope = [](const Vec3d& up, const Vec3d& down) { return (up - down) / (2 * kStep); };
      EXPECT_NEAR(glm::length(slope(tilted_normal(x + kStep, y), tilted_normal(x - kStep, y)) - slopes.by_x), 0, 1e-8);
      EXPECT_NEAR(glm::length(slope(tilted_normal(x, y + kStep), tilted_normal(x, y - kStep)) - slopes.by_y), 0, 1e-8);
      EXPECT_NEAR(glm::length(tilted_normal(x, y)), 1, 1e-14);
    }
  }
}

}  // namespace
}  // namespace velour::warped_lobe_test
