#include "btf/fit/byte_rounding.h"

#include <gtest/gtest.h>

#include "math/sphere/random.h"

namespace velour::byte_rounding_test {
namespace {

constexpr size_t kLobes = 6, kTexels = 200;

/// Gaussians over a line that overlap much: sums of large coefficients cancel.
Eigen::MatrixXf random_lobes() {
  Eigen::MatrixXf values(100, kLobes);
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    for (Eigen::Index k = 0; k < values.cols(); ++k) {
      const float off = 0.01f * static_cast<float>(i) - 0.2f * static_cast<float>(k);
      values(i, k) = std::exp(-3 * off * off);
    }
  }
  return values;
}

/// Relative L2 error of the sums, with errors made up for or not.
double error_of(bool feedback) {
  const Eigen::MatrixXf g = random_lobes();
  LobeProductMeans products;
  products[0] = g.transpose() * g / static_cast<float>(g.rows());
  if (!feedback) products[0] = products[0].diagonal().asDiagonal();
  SrbfSide side;
  side.lobes.resize(kLobes);
  for (uint16_t k = 0; k < kLobes; ++k) side.lobe[0].push_back(k);
  side.levels = {{kTexels, 1, {}, {}}};
  std::vector<float> values;
  RandomStream random(1, 0, 0);
  for (size_t i = 0; i < kTexels * kLobes; ++i) values.push_back((i % 2 ? -20.0f : 20.0f) * random.next());
  set_rounded(products, {values}, side);
  double error = 0, energy = 0;
  for (size_t t = 0; t < kTexels; ++t) {
    Eigen::VectorXf exact(kLobes), rounded(kLobes);
    for (size_t k = 0; k < kLobes; ++k) {
      exact[static_cast<Eigen::Index>(k)] = values[t * kLobes + k];
      rounded[static_cast<Eigen::Index>(k)] = side.scale[k].value(side.levels[0].value[t * kLobes + k]);
    }
    error += static_cast<double>((g * (exact - rounded)).squaredNorm());
    energy += static_cast<double>((g * exact).squaredNorm());
  }
  return std::sqrt(error / energy);
}

TEST(ByteRounding, MakesUpForWhatItDoes) {
  const double plain = error_of(false), made_up = error_of(true);
  EXPECT_GT(plain, 2e-3) << "the control";
  EXPECT_LT(made_up, 0.5 * plain);
}

}  // namespace
}  // namespace velour::byte_rounding_test
