#include "math/srbf/kernel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace velour::widened_lobe_test {
namespace {

constexpr double kGolden = 0.6180339887498949;
const double kInfinity = std::numeric_limits<double>::infinity();

/// Point `i` of `count`, evenly spread, of a Gaussian density about unit `axis`.
Vec3d drawn(const Vec3d& axis, double bandwidth, int i, int count) {
  const double d = kernel_sample(Kernel::gaussian, bandwidth, (i + 0.5) / count);
  const double sine = std::sqrt(d * (2 - d)), phi = 2 * kPiD * std::fmod(i * kGolden, 1.0);
  const Vec3d x = glm::normalize(glm::cross(axis, std::abs(axis.z) < 0.9 ? Vec3d(0, 0, 1) : Vec3d(1, 0, 0)));
  return sine * (std::cos(phi) * x + std::sin(phi) * glm::cross(axis, x)) + (1 - d) * axis;
}

/// A lobe of light directions, so that the argument is the direction.
double kernel_at(const WarpedLobe& lobe, const Vec3d& y) { return warped_kernel(lobe, y, {0, 0, 1}); }

/// Relative L2 over the sphere of the widened kernel against the convolution, both of integral 1, by sums.
double error_of(const WarpedLobe& lobe, double by) {
  const WarpedLobe wider = widened(lobe, by);
  const Vec3d peak = argument_at(lobe, lobe.center);
  constexpr int kPlaces = 400, kDraws = 1500;
  // Where it matters: places drawn about the peak from a density that is broader than both.
  const double broad =
      0.4 /
      (std::exp(2 * std::hypot(exponents_of(lobe.stretch).x, exponents_of(lobe.stretch).y)) / lobe.bandwidth + 1 / by);
  double ours = 0, exact = 0;
  std::vector<double> a, b, w;
  for (int i = 0; i < kPlaces; ++i) {
    const Vec3d y = drawn(peak, broad, i, kPlaces);
    double sum = 0;
    for (int k = 0; k < kDraws; ++k) sum += kernel_at(lobe, drawn(y, by, k, kDraws));
    a.push_back(kernel_at(wider, y));
    b.push_back(sum / kDraws);
    w.push_back(std::exp(broad * one_minus_dot(y, peak)));
    ours += w.back() * a.back();
    exact += w.back() * b.back();
  }
  double wrong_sq = 0, whole_sq = 0;
  for (size_t i = 0; i < w.size(); ++i) {
    const double difference = a[i] / ours - b[i] / exact;
    wrong_sq += w[i] * difference * difference;
    whole_sq += w[i] * b[i] / exact * b[i] / exact;
  }
  return std::sqrt(wrong_sq / whole_sq);
}

TEST(Roughness, AMirrorGetsTheFacetsOfItsAlpha) {
  // Beckmann's exp(-tan^2 / alpha^2) and our exp(-lambda (1 - cos)) near the normal.
  for (const double roughness : {0.1, 0.3, 0.6}) {
    const double alpha_sq = std::pow(roughness, 4), angle = 0.3 * roughness * roughness;
    const double beckmann = std::exp(-std::pow(std::tan(angle), 2) / alpha_sq);
    const double d = 2 * std::pow(std::sin(0.5 * angle), 2);
    EXPECT_NEAR(kernel_value(Kernel::gaussian, half_bandwidth_of_roughness(roughness), d), beckmann, 0.01);
  }
  // At the normal a light turns by twice what its half vector does.
  EXPECT_NEAR(light_bandwidth_of_roughness(0.3, 1) * 4, half_bandwidth_of_roughness(0.3), 1e-9);
}

TEST(WidenedBandwidth, KeepsTheMeanCosineOfTheConvolution) {
  for (const double bandwidth : {1e-4, 0.03, 0.06, 1.0, 30.0, 1e4, 1e8}) {
    for (const double by : {0.1, 3.0, 200.0, 1e6}) {
      const double wider = widened_bandwidth(Kernel::gaussian, bandwidth, by);
      const double a = gaussian_one_minus_mean(bandwidth), b = gaussian_one_minus_mean(by), exact = a + b - a * b;
      EXPECT_NEAR(gaussian_one_minus_mean(wider), exact, 1e-5 * std::min(exact, 1 - exact)) << bandwidth << " " << by;
      EXPECT_LE(wider, std::min(bandwidth, by));
    }
  }
}

TEST(WidenedBandwidth, AbelPoissonIsExact) {
  // The density of an Abel-Poisson kernel b convolved with that of c is that of b c; a Gaussian stands for the latter
  // by its mean cosine, which is c.
  EXPECT_NEAR(widened_bandwidth(Kernel::abel_poisson, 0.8, 20), 0.8 * (1 - gaussian_one_minus_mean(20)), 1e-12);
}

TEST(WidenedBandwidth, OfNothingStays) {
  for (const double b : {1e-5, 0.04, 0.5, 7.0, 1e9}) {
    EXPECT_NEAR(widened_bandwidth(Kernel::gaussian, b, kInfinity), b, 1e-7 * b);
  }
  EXPECT_EQ(widened_bandwidth(Kernel::abel_poisson, 0.7, kInfinity), 0.7);
}

// The closed form of the convolution of two Gaussians is no Gaussian; how near ours is to it.
TEST(WidenedBandwidth, IsNearTheConvolution) {
  const Vec3d a(0, 0, 1);
  for (const double bandwidth : {0.5, 4.0, 50.0, 1e4}) {
    for (const double by : {0.5, 4.0, 50.0, 1e4}) {
      const double wider = widened_bandwidth(Kernel::gaussian, bandwidth, by);
      const double scale = kernel_integral(Kernel::gaussian, wider) /
                           (kernel_integral(Kernel::gaussian, bandwidth) * kernel_integral(Kernel::gaussian, by));
      double wrong_sq = 0, whole_sq = 0;
      for (int i = 0; i < 2000; ++i) {  // evenly over the density of a broader lobe
        const double d = kernel_sample(Kernel::gaussian, 0.5 * wider, (i + 0.5) / 2000);
        const Vec3d b(std::sqrt(d * (2 - d)), 0, 1 - d);
        const double exact = scale * kernel_convolution(Kernel::gaussian, a, bandwidth, b, by);
        const double weight = std::exp(0.5 * wider * d);
        wrong_sq += weight * std::pow(kernel_value(Kernel::gaussian, wider, d) - exact, 2);
        whole_sq += weight * exact * exact;
      }
      EXPECT_LT(std::sqrt(wrong_sq / whole_sq), 0.06) << bandwidth << " " << by;
    }
  }
}

TEST(WidenedLobe, ARoundOneStaysRoundAndInPlace) {
  for (const double tilt : {0.0, 0.7, kPiD / 2, 2.5}) {
    const WarpedLobe lobe{LobeSpace::light, {}, tilted_normal(0.8 * tilt, -0.6 * tilt), 40, Vec3d(2)};
    const WarpedLobe wider = widened(lobe, 60);
    EXPECT_NEAR(glm::length(wider.center - lobe.center), 0, 2e-6) << tilt;
    EXPECT_NEAR(glm::length(exponents_of(wider.stretch)), 0, 1e-5) << tilt;
    EXPECT_NEAR(wider.bandwidth, widened_bandwidth(Kernel::gaussian, 40, 60), 1e-4) << tilt;
    EXPECT_EQ(wider.coefficient, lobe.coefficient);
  }
}

struct Shape {
  double a, b, tilt_x, tilt_y, bandwidth;
};

WarpedLobe lobe_of(const Shape& s) {
  return {LobeSpace::light, stretch_from(s.a, s.b), tilted_normal(s.tilt_x, s.tilt_y), s.bandwidth, Vec3d(1)};
}

TEST(WidenedLobe, FollowsTheConvolutionOfStretchedOnes) {
  const Shape shapes[] = {
      {0.8, 0, 0, 0, 400}, {0.5, 0.4, 0, 0, 100}, {0.6, 0, 0.2, 0, 300}, {-0.4, 0.3, -0.1, 0.1, 200}};
  for (const Shape& s : shapes) {
    for (const double by : {60.0, 300.0, 3000.0}) {
      EXPECT_LT(error_of(lobe_of(s), by), 0.08) << s.a << " " << s.b << " " << s.tilt_x << " " << by;
    }
  }
  // Control: widening changes the stretch, so a lobe that kept its own would be far off.
  EXPECT_GT(glm::length(exponents_of(lobe_of(shapes[0]).stretch)) -
                glm::length(exponents_of(widened(lobe_of(shapes[0]), 60).stretch)),
            0.4);
}

TEST(WidenedLobe, IsWiderTheMoreItIsWidened) {
  for (const Shape& s : {Shape{0.8, 0.1, 0.4, 0.2, 400}, Shape{1.5, 0, 0, 0, 3}, Shape{0, 0, 1.2, 0, 1e6}}) {
    WarpedLobe last = lobe_of(s);
    const Vec3d peak = argument_at(last, last.center);
    for (double by = 1e6; by > 0.3; by /= 7) {
      const WarpedLobe wider = widened(lobe_of(s), by);
      EXPECT_LT(wider.bandwidth, last.bandwidth);
      EXPECT_NEAR(glm::length(argument_at(wider, wider.center) - peak), 0, 1e-5);
      last = wider;
    }
  }
}

TEST(Stretch, ExponentsAndTiltsAreFoundAgain) {
  for (const glm::dvec2 e : {glm::dvec2(0.0), glm::dvec2(1e-10, 0), glm::dvec2(0.7, -1.1), glm::dvec2(-5, 0.3)}) {
    EXPECT_NEAR(glm::length(exponents_of(stretch_from(e.x, e.y)) - e), 0, 1e-9);
  }
  for (const glm::dvec2 t : {glm::dvec2(0.0), glm::dvec2(1e-10, 0), glm::dvec2(0.7, -1.1), glm::dvec2(-3, 0.3)}) {
    EXPECT_NEAR(glm::length(tilt_of(tilted_normal(t.x, t.y)) - t), 0, 1e-9);
  }
}

TEST(LobeLight, OfAKernelAboveTheHorizon) {
  for (const double l : {0.01, 1.0, 30.0, 1e4}) {
    const double all = kernel_integral(Kernel::gaussian, l), above = -2 * kPiD * std::expm1(-l) / l;
    EXPECT_NEAR(kernel_integral_above(Kernel::gaussian, l, 1), above, 6e-3 * all);
    EXPECT_NEAR(kernel_integral_above(Kernel::gaussian, l, -1), all - above, 6e-3 * all);
    EXPECT_NEAR(kernel_integral_above(Kernel::gaussian, l, 0), all / 2, 1e-9 * all);
    EXPECT_NEAR(kernel_integral_above(Kernel::gaussian, l, 0.3) + kernel_integral_above(Kernel::gaussian, l, -0.3), all,
                1e-9 * all);
  }
}

TEST(LobeLight, OfALobeAtAView) {
  for (const LobeSpace space : {LobeSpace::light, LobeSpace::half}) {
    for (const double theta_v : {0.0, 0.8, 1.4}) {
      const WarpedLobe lobe{space, stretch_from(0.3, 0.1), tilted_normal(0.3, 0.1), 15, Vec3d(1)};
      const Vec3d wv(std::sin(theta_v), 0, std::cos(theta_v));
      double sum = 0;
      constexpr int kLights = 400'000;
      for (int i = 0; i < kLights; ++i) {  // cosine-distributed
        const double u = (i + 0.5) / kLights, phi = 2 * kPiD * std::fmod(i * kGolden, 1.0), r = std::sqrt(u);
        sum += warped_kernel(lobe, {r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u)}, wv);
      }
      const double exact = sum * kPiD / kLights;
      EXPECT_NEAR(reflected_light(lobe, wv), exact, 0.01 * exact) << theta_v;
    }
  }
}

}  // namespace
}  // namespace velour::widened_lobe_test
