#include "math/srbf/kernel.h"

#include <gtest/gtest.h>

#include "math/sphere/directions.h"
#include "math/sphere/quadrature.h"

namespace velour::kernel_test {
namespace {

constexpr Kernel kGaussian = Kernel::gaussian;
constexpr Kernel kAbelPoisson = Kernel::abel_poisson;

const Vec3d kA = glm::normalize(Vec3d(0.3, -0.5, 0.8));
const Vec3d kB = glm::normalize(Vec3d(-0.6, 0.2, 0.4));

void expect_close(double value, double expected, double relative) {
  EXPECT_NEAR(value, expected, relative * std::abs(expected));
}

std::vector<double> bandwidths(Kernel kernel) {
  if (kernel == kGaussian) return {0, 1e-8, 1e-4, 1e-3, 0.5, 5, 44.5, 88.5, 1e3, 1e6};
  return {0, 1e-4, 0.1, 0.5, 0.9, 0.999, 1 - 0x1p-24};
}

// Integrates g(d) over the sphere on panels that shrink by half towards the center, so that no lobe is too sharp.
template <class G>
double integrate_zonal(const G& g) {
  double sum = 0;
  for (double top = 2; top > 1e-28; top *= 0.5) {
    const Quadrature q = gauss_legendre(16, 0.5 * top, top);
    for (size_t i = 0; i < q.node.size(); ++i) sum += q.weight[i] * g(q.node[i]);
  }
  return 2 * kPiD * sum;
}

// Integrates over the sphere with polar axis `axis`: Gauss-Legendre in the cosine, equal steps in azimuth.
template <class G>
double integrate_sphere(const G& g) {
  const Quadrature q = gauss_legendre(120, -1, 1);
  constexpr int kAzimuths = 240;
  double sum = 0;
  for (size_t i = 0; i < q.node.size(); ++i) {
    const double z = q.node[i], r = std::sqrt(1 - z * z);
    for (int k = 0; k < kAzimuths; ++k) {
      const double phi = 2 * kPiD * k / kAzimuths;
      sum += q.weight[i] * g(Vec3d(r * std::cos(phi), r * std::sin(phi), z));
    }
  }
  return sum * 2 * kPiD / kAzimuths;
}

TEST(Kernel, AgreesWithReferenceNumbers) {
  EXPECT_NEAR(glm::dot(kA, kB), 0.0539949247156, 1e-12);
  expect_close(kernel_integral(kGaussian, 0.5), 7.9434612152, 1e-10);
  expect_close(kernel_integral(kGaussian, 8), 0.785398075013, 1e-11);
  expect_close(kernel_integral(kGaussian, 60), 0.10471975512, 1e-11);
  expect_close(kernel_convolution(kAbelPoisson, kA, 0.6, kB, 0.8), 7.55865780044, 1e-11);
  expect_close(kernel_convolution(kGaussian, kA, 9, kB, 25), 2.17170460696e-4, 1e-10);
  const GaussianProduct product = gaussian_product(kA, 9, kB, 25);
  expect_close(product.bandwidth, 27.0240210946, 1e-11);
  expect_close(std::log(product.scale), -6.97597890539, 1e-11);
}

TEST(Kernel, InverseDistributionAgreesWithReferenceNumbers) {
  EXPECT_NEAR(1 - kernel_sample(kGaussian, 7, 0.05), 0.572040503624, 1e-12);
  EXPECT_NEAR(1 - kernel_sample(kGaussian, 7, 0.4), 0.869101502203, 1e-12);
  EXPECT_NEAR(1 - kernel_sample(kGaussian, 7, 0.93), 0.989632767108, 1e-12);
  EXPECT_NEAR(1 - kernel_sample(kAbelPoisson, 0.8, 0.05), -0.00816326530612, 1e-12);
  EXPECT_NEAR(1 - kernel_sample(kAbelPoisson, 0.8, 0.4), 0.910204081633, 1e-12);
  EXPECT_NEAR(1 - kernel_sample(kAbelPoisson, 0.8, 0.93), 0.996572404034, 1e-12);
}

TEST(Kernel, IntegralAgreesWithQuadrature) {
  for (const Kernel kernel : {kGaussian, kAbelPoisson}) {
    for (const double l : bandwidths(kernel)) {
      const double numeric = integrate_zonal([&](double d) { return kernel_value(kernel, l, d); });
      expect_close(kernel_integral(kernel, l), numeric, 1e-9);
    }
  }
}

// Mass of the kernel between its center and d; the complement of u.
double mass_within(Kernel kernel, double l, double d) {
  if (kernel == kGaussian) return l == 0 ? d / 2 : std::expm1(-l * d) / std::expm1(-2 * l);
  return l == 0 ? d / 2 : (1 - l * l) / (2 * l) * (1 / (1 - l) - 1 / std::sqrt((1 - l) * (1 - l) + 2 * l * d));
}

TEST(Kernel, SampleInvertsTheDistribution) {
  for (const Kernel kernel : {kGaussian, kAbelPoisson}) {
    for (const double l : bandwidths(kernel)) {
      if (kernel == kAbelPoisson && l > 0.9999) continue;  // the forward formula above cancels there, not the inverse
      for (const double u : {1e-6, 0.01, 0.3, 0.5, 0.9, 0.999}) {
        EXPECT_NEAR(mass_within(kernel, l, kernel_sample(kernel, l, u)), 1 - u, 1e-8) << l << ' ' << u;
      }
    }
  }
}

TEST(Kernel, SampleHoldsAtTheEndsOfTheUnitInterval) {
  for (const Kernel kernel : {kGaussian, kAbelPoisson}) {
    for (const double l : bandwidths(kernel)) {
      EXPECT_NEAR(kernel_sample(kernel, l, 0.0), 2.0, 1e-9) << l;
      const double last = kernel_sample(kernel, l, 1 - 0x1p-53);
      EXPECT_GE(last, 0);
      EXPECT_LT(last, 1e-7);
      EXPECT_GT(kernel_sample(kernel, l, 1 - 0x1p-24), 0);
    }
  }
}

TEST(Kernel, FlatLimitIsReachedSmoothly) {
  expect_close(kernel_integral(kGaussian, 0), 4 * kPiD, 1e-15);
  expect_close(kernel_integral(kGaussian, 1e-300), 4 * kPiD, 1e-15);
  expect_close(kernel_integral(kGaussian, 1e-4), 4 * kPiD * (1 - 1e-4), 1e-7);
  for (const double u : {0.0, 0.25, 0.75}) {
    EXPECT_NEAR(kernel_sample(kGaussian, 1e-12, u), 2 * (1 - u), 1e-11);
    EXPECT_NEAR(kernel_sample(kAbelPoisson, 1e-12, u), 2 * (1 - u), 1e-11);
  }
}

TEST(Kernel, SharpLobesStayFinite) {
  for (const double l : {44.5, 88.5, 1e4, 1e8}) {
    EXPECT_EQ(kernel_value(kGaussian, l, 0), 1);
    EXPECT_GE(kernel_value(kGaussian, l, 2), 0);
    expect_close(kernel_integral(kGaussian, l), 2 * kPiD / l, 1e-15);
    EXPECT_TRUE(std::isfinite(kernel_convolution(kGaussian, kA, l, kB, l)));
    expect_close(kernel_convolution(kGaussian, kA, l, kA, l), kPiD / l, 1e-12);
  }
  const double sharp = 1 - 0x1p-40;
  expect_close(kernel_value(kAbelPoisson, sharp, 0), (1 + sharp) / (0x1p-40 * 0x1p-40), 1e-12);
  EXPECT_GT(kernel_value(kAbelPoisson, sharp, 2), 0);
}

TEST(Kernel, ConvolutionAgreesWithQuadrature) {
  struct Case {
    Kernel kernel;
    double la, lb;
  };
  for (const Case& c : {Case{kGaussian, 3, 11}, {kGaussian, 0.2, 0.1}, {kAbelPoisson, 0.6, 0.3}}) {
    for (const Vec3d& b : {kB, kA, -kA}) {
      const double numeric = integrate_sphere([&](const Vec3d& w) {
        return kernel_value(c.kernel, c.la, one_minus_dot(w, kA)) * kernel_value(c.kernel, c.lb, one_minus_dot(w, b));
      });
      expect_close(kernel_convolution(c.kernel, kA, c.la, b, c.lb), numeric, 1e-9);
    }
  }
}

TEST(Kernel, OpposedGaussiansConvolveToTheLimit) {
  for (const double l : {0.0, 1e-6, 1.0, 50.0}) {
    const GaussianProduct product = gaussian_product(kA, l, -kA, l);
    EXPECT_NEAR(product.bandwidth, 0, 1e-12);
    EXPECT_NEAR(glm::length(product.center), 1, 1e-12);
    expect_close(product.scale, std::exp(-2 * l), 1e-12);
    expect_close(kernel_convolution(kGaussian, kA, l, -kA, l), 4 * kPiD * std::exp(-2 * l), 1e-12);
  }
}

TEST(Kernel, ProductOfGaussiansIsOneGaussian) {
  for (const auto& [la, lb] : {std::pair{9.0, 25.0}, {0.0, 3.0}, {1e4, 2e4}, {5.0, 5.0}}) {
    const Vec3d b = la > 1e3 ? glm::normalize(kA + 0.01 * kB) : kB;
    const GaussianProduct product = gaussian_product(kA, la, b, lb);
    for (const Vec3& direction : sphere_fibonacci(50)) {
      const Vec3d w = la > 1e3 ? glm::normalize(kA + 0.01 * Vec3d(direction)) : glm::normalize(Vec3d(direction));
      const double separate =
          kernel_value(kGaussian, la, one_minus_dot(w, kA)) * kernel_value(kGaussian, lb, one_minus_dot(w, b));
      const double joint = product.scale * kernel_value(kGaussian, product.bandwidth, one_minus_dot(w, product.center));
      EXPECT_NEAR(joint, separate, 1e-9 * separate + 1e-300);
    }
  }
}

TEST(Kernel, MeanCosineOfAGaussianAgreesWithQuadratureAndIsInverted) {
  for (const double l : {0.05, 0.5, 5.0, 19.9, 20.1, 1e3, 1e6}) {
    const double moment = integrate_zonal([&](double d) { return d * kernel_value(kGaussian, l, d); });
    expect_close(gaussian_one_minus_mean(l), moment / kernel_integral(kGaussian, l), 1e-9);
    expect_close(gaussian_bandwidth_of_mean(gaussian_one_minus_mean(l)), l, 1e-6);
  }
  EXPECT_EQ(gaussian_one_minus_mean(0), 1);
  EXPECT_EQ(gaussian_bandwidth_of_mean(1), kMinMeanBandwidth);
  EXPECT_EQ(gaussian_bandwidth_of_mean(0), kMaxMeanBandwidth);
}

TEST(Kernel, CenterAndAntipode) {
  expect_close(kernel_value(kAbelPoisson, 0.5, 0), 1.5 / 0.25, 1e-15);
  expect_close(kernel_value(kAbelPoisson, 0.5, 2), 0.75 / (2.25 * 1.5), 1e-15);
  expect_close(kernel_value(kGaussian, 3, 2), std::exp(-6.0), 1e-15);
  EXPECT_EQ(one_minus_dot(kA, kA), 0);
  EXPECT_NEAR(one_minus_dot(kA, -kA), 2, 1e-15);
}

}  // namespace
}  // namespace velour::kernel_test
