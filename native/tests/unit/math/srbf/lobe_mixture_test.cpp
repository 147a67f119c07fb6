#include "math/srbf/lobe_mixture.h"

#include <gtest/gtest.h>

#include "math/sphere/frame.h"
#include "support/mixtures.h"
#include "support/simd_targets.h"

namespace velour::lobe_mixture_test {
namespace {

using test::batch_of;

LobeMixture one_lobe(Kernel kernel, const Vec3& center, float bandwidth, float share = 0) {
  LobeMixture mixture;
  mixture.clear(kernel);
  mixture.add(center, bandwidth, {1, 1, 1});
  mixture.finish(share);
  return mixture;
}

// Directions about `center` at |w - center|^2 / 2 from far inside the lobe to the antipode.
std::vector<Vec3> directions_about(const Vec3& center) {
  const Frame frame = Frame::about(center);
  std::vector<Vec3> set{center, -center};
  for (int i = 0; i < 62; ++i) {
    const double d = 2 * std::pow(1e-9, 1 - i / 61.0);
    const double sine = std::sqrt(d * (2 - d));
    set.push_back(frame.to_world(Vec3(sine * std::cos(i), sine * std::sin(i), 1 - d)));
  }
  return set;
}

void expect_matches_reference(const LobeMixture& mixture, const std::vector<Vec3>& directions, float bandwidth) {
  const DirectionBatch batch = batch_of(directions);
  RgbBatch value;
  ScalarBatch pdf, density;
  eval_mixture(mixture, batch, value, pdf);
  eval_density(mixture, batch, density);
  for (int i = 0; i < batch.count; ++i) {
    const Vec3 w = batch.get(i);
    const test::MixtureValue expected = test::reference_mixture(mixture, w);
    // The distance between float directions carries a few 2^-24 of itself into the exponent.
    double exponent = 0;
    if (mixture.kernel == Kernel::gaussian) {
      exponent = bandwidth * one_minus_dot(Vec3d(w), Vec3d(mixture.x[0], mixture.y[0], mixture.z[0]));
    }
    const double tolerance = (exponent > 87 ? 1 : 6e-7 + 4e-7 * exponent);
    EXPECT_NEAR(value.r[i], expected.value[0], tolerance * expected.value[0] + 1e-37) << bandwidth << ' ' << i;
    EXPECT_NEAR(pdf.v[i], expected.pdf, tolerance * expected.pdf + 1e-37 * bandwidth) << bandwidth << ' ' << i;
    EXPECT_NEAR(density.v[i], expected.pdf, tolerance * expected.pdf + 1e-37 * bandwidth) << bandwidth << ' ' << i;
    if (exponent > 88) {
      EXPECT_EQ(value.r[i], 0) << bandwidth << ' ' << i;
    }
  }
}

TEST(LobeMixture, MatchesTheScalarReferenceOnEveryTarget) {
  test::on_every_simd_target([] {
    for (const Kernel kernel : {Kernel::gaussian, Kernel::abel_poisson}) {
      for (const float bandwidth : test::bandwidth_grid(kernel)) {
        for (const Vec3& center : sphere_fibonacci(5)) {
          expect_matches_reference(one_lobe(kernel, center, bandwidth), directions_about(center), bandwidth);
        }
      }
    }
  });
}

// At the antipode |w - xi|^2 is exactly 4, so the exponent is known as the kernel rounds it and what is left is the
// error of the exponential.
TEST(LobeMixture, ExponentialKeepsItsAccuracyOverItsRange) {
  const DirectionBatch antipode = batch_of(std::vector<Vec3>(16, Vec3(0, 0, -1)));
  test::on_every_simd_target([&] {
    double largest = 0;
    for (int i = 0; i <= 40000; ++i) {
      const float bandwidth = 43.6f * static_cast<float>(i) / 40000;
      RgbBatch value;
      ScalarBatch pdf;
      eval_mixture(one_lobe(Kernel::gaussian, {0, 0, 1}, bandwidth), antipode, value, pdf);
      const double expected = std::exp2(4.0 * static_cast<double>(bandwidth * -0.72134752f));
      largest = std::max(largest, std::abs(value.r[0] / expected - 1));
    }
    EXPECT_LT(largest, 1.8e-7);
  });
}

TEST(LobeMixture, EveryCountOfDirectionsIsComputedAlike) {
  test::on_every_simd_target([] {
    const auto directions = sphere_fibonacci(64);
    for (int count = 0; count <= 64; ++count) {
      const LobeMixture mixture = test::random_mixture(Kernel::gaussian, count % 13, 3);
      const DirectionBatch batch = batch_of(std::span(directions).first(static_cast<size_t>(count)));
      RgbBatch value;
      ScalarBatch pdf, density;
      eval_mixture(mixture, batch, value, pdf);
      eval_density(mixture, batch, density);
      for (int i = 0; i < count; ++i) {
        const auto expected = test::reference_mixture(mixture, directions[static_cast<size_t>(i)]);
        EXPECT_NEAR(value.b[i], expected.value[2], 1e-5 * expected.value[2] + 1e-30);
        EXPECT_NEAR(pdf.v[i], expected.pdf, 1e-5 * expected.pdf + 1e-30);
        EXPECT_NEAR(density.v[i], expected.pdf, 1e-5 * expected.pdf + 1e-30);
      }
    }
  });
}

TEST(LobeMixture, WithoutMassIsTheCosine) {
  LobeMixture empty;
  empty.clear(Kernel::gaussian);
  LobeMixture finished = empty, black = empty;
  finished.finish(0.05f);
  black.add({0, 0, 1}, 5, {0, 0, 0});
  black.finish(0.05f);
  for (const LobeMixture& mixture : {empty, finished, black}) {
    const DirectionBatch batch = batch_of(sphere_fibonacci(33));
    RgbBatch value;
    ScalarBatch pdf;
    eval_mixture(mixture, batch, value, pdf);
    for (int i = 0; i < batch.count; ++i) {
      EXPECT_EQ(value.get(i), Rgb(0));
      EXPECT_NEAR(pdf.v[i], std::max(0.0f, batch.z[i]) / kPi, 1e-7f);
    }
    EXPECT_GE(sample_mixture(mixture, {1 - 0x1p-24f, 0.3f}).z, 0);
  }
}

TEST(LobeMixture, DiffuseTermHasItsShareOfValueAndSamples) {
  LobeMixture mixture = one_lobe(Kernel::gaussian, glm::normalize(Vec3(0.3f, 0, 1)), 40);
  mixture.add_diffuse({0.2f, 0.1f, 0.3f});
  const DirectionBatch batch = batch_of(sphere_fibonacci(63));
  const float share = 0.05f;
  LobeMixture plain = one_lobe(Kernel::gaussian, glm::normalize(Vec3(0.3f, 0, 1)), 40);
  mixture.clear(Kernel::gaussian);
  EXPECT_EQ(mixture.diffuse_r, 0);  // cleared with the lobes
  mixture.add(glm::normalize(Vec3(0.3f, 0, 1)), 40, {1, 1, 1});
  mixture.add_diffuse({0.2f, 0.1f, 0.3f});
  mixture.add_diffuse({0.1f, 0.1f, 0.0f});
  mixture.finish(share);
  RgbBatch value, lobe_value;
  ScalarBatch pdf, lobe_pdf;
  eval_mixture(mixture, batch, value, pdf);
  eval_mixture(plain, batch, lobe_value, lobe_pdf);
  const double lobe_mass = kernel_integral(Kernel::gaussian, 40), diffuse_mass = luminance({0.3f, 0.2f, 0.3f}) * kPiD;
  const double expected = share + (1 - share) * diffuse_mass / (diffuse_mass + lobe_mass);
  EXPECT_NEAR(mixture.cosine_share, expected, 1e-6);
  for (int i = 0; i < batch.count; ++i) {
    const float cosine = std::max(batch.z[i], 0.0f);
    EXPECT_NEAR(value.g[i], lobe_value.g[i] + 0.2f * cosine, 1e-6f);
    EXPECT_NEAR(pdf.v[i], expected * cosine / kPiD + (1 - expected) * lobe_pdf.v[i], 1e-5);
  }
}

TEST(LobeMixture, DensityIsProbabilityOverIntegral) {
  const float share = 0.1f;
  for (const Kernel kernel : {Kernel::gaussian, Kernel::abel_poisson}) {
    const LobeMixture mixture = test::random_mixture(kernel, 12, 7, share);
    double mass = share, before = 0;
    for (int j = 0; j < mixture.count; ++j) {
      const double lobe = mixture.density[j] * kernel_integral(kernel, mixture.bandwidth[j]);
      EXPECT_NEAR(lobe, (1 - share) * (mixture.cdf[j] - before), 1e-6);
      before = mixture.cdf[j];
      mass += lobe;
    }
    EXPECT_EQ(mixture.cdf[mixture.count - 1], 1);
    EXPECT_NEAR(mass, 1, 1e-6);
  }
}

TEST(LobeMixture, AppendTurnsAndScalesLikeAdd) {
  const LobeMixture source = test::random_mixture(Kernel::gaussian, 7, 11);
  const Mat3 rotation = rotation_between({0, 0, 1}, glm::normalize(Vec3(1, 2, -1)));
  std::vector<float> shine, mass;
  LobeMixture expected, appended;
  expected.clear(Kernel::gaussian);
  for (int j = 0; j < source.count; ++j) {
    const Rgb coefficient(source.r[j], source.g[j], source.b[j]);
    shine.push_back(luminance(coefficient));
    mass.push_back(shine.back() * static_cast<float>(kernel_integral(Kernel::gaussian, source.bandwidth[j])));
    expected.add(rotation * Vec3(source.x[j], source.y[j], source.z[j]), source.bandwidth[j], 0.3f * coefficient);
  }
  expected.finish(0.05f);
  appended.clear(Kernel::gaussian);
  appended.append({source.x, source.y, source.z, source.bandwidth, source.r, source.g, source.b, shine.data(),
                   mass.data(), source.count},
                  rotation, 0.3f);
  appended.finish(0.05f);
  ASSERT_EQ(appended.count, expected.count);
  for (int j = 0; j < expected.count; ++j) {
    EXPECT_NEAR(appended.y[j], expected.y[j], 1e-6);
    EXPECT_NEAR(appended.g[j], expected.g[j], 1e-6);
    EXPECT_NEAR(appended.density[j], expected.density[j], 1e-5 * expected.density[j]);
    EXPECT_NEAR(appended.cdf[j], expected.cdf[j], 1e-6);
  }
}

}  // namespace
}  // namespace velour::lobe_mixture_test
