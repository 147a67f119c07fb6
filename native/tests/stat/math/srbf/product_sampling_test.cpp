// Products of two lobes as a sampling density: any two bandwidths at any angle.
#include "math/srbf/lobe_products.h"
#include "support/lobe_cells.h"

namespace velour::product_sampling_test {
namespace {

constexpr float kBandwidths[] = {1e-4f, 1e-2f, 1, 100, 1e4f, 1e6f};

/// The density of the product of a lobe with two others, one `angle` away from it and a weaker one beyond, which is
/// not too sharp for cells about the first.
LobeMixture product_density(float a, float b, float angle, float error = 1) {
  GaussianLobes others;
  others.add({direction(0.4f + angle, 0.3f), b, 1});
  others.add({direction(0.4f + 1.5f * angle, 0.5f), 0.5f * std::min(b, 100.0f), 0.3f});
  LobeProducts products;
  multiply_lobes({direction(0.4f, 0.3f), a * error, 1}, in_blocks(others), nullptr, products);
  LobeMixture density;
  EXPECT_TRUE(keep_products(products, 0, density)) << a << ' ' << b << ' ' << angle;
  return density;
}

using ProductCase = std::tuple<float, float, float>;

class ProductSampling : public ::testing::TestWithParam<ProductCase> {};

TEST_P(ProductSampling, FollowsItsDensity) {
  const auto [a, b, angle] = GetParam();
  // Farther apart than the exponent of a float reaches: no product has mass.
  const double least = std::min(static_cast<double>(a), static_cast<double>(b));
  const float held = std::min(angle, static_cast<float>(4 / std::sqrt(std::max(least, 1.0))));
  test::expect_proven(test::mixture_sampler(product_density(a, b, held)), "product");
}

INSTANTIATE_TEST_SUITE_P(All, ProductSampling,
                         ::testing::Combine(::testing::ValuesIn(kBandwidths), ::testing::ValuesIn(kBandwidths),
                                            ::testing::Values(0.0f, 0.3f, 1.6f)));

TEST(ProductSamplingControl, ABandwidthOffByFivePercentIsSeen) {
  for (const float bandwidth : {100.0f, 1e6f}) {
    const auto right = test::mixture_sampler(product_density(bandwidth, 1, 0.3f));
    EXPECT_LT(test::p_value(right, test::mixture_sampler(product_density(bandwidth, 1, 0.3f, 1.05f))), 1e-6);
  }
}

}  // namespace
}  // namespace velour::product_sampling_test
