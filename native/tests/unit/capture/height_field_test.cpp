#include "capture/goniometer/height_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace velour::height_field_test {
namespace {

double correlation_at(const std::vector<double>& field, int cells, int dx, int dy) {
  double sum = 0;
  for (int y = 0; y < cells; ++y) {
    for (int x = 0; x < cells; ++x) {
      const auto at = [&](int i, int j) { return field[static_cast<size_t>((j % cells) * cells + i % cells)]; };
      sum += at(x, y) * at(x + dx, y + dy);
    }
  }
  return sum / static_cast<double>(field.size());
}

TEST(GaussianField, HasTheVarianceAndAutocorrelationAskedFor) {
  constexpr int cells = 256, fields = 8;
  constexpr double correlation = 6;
  // About (256 / 6 / 1.8)^2 x 8 independent patches: 1.5 % on a variance.
  for (const auto& [dx, dy] : {std::pair{0, 0}, {3, 0}, {0, 6}, {4, 4}, {20, 0}}) {
    double mean = 0;
    for (uint64_t s = 0; s < fields; ++s) {
      mean += correlation_at(gaussian_field(cells, correlation, 3, s), cells, dx, dy) / fields;
    }
    EXPECT_NEAR(mean, std::exp(-(dx * dx + dy * dy) / (correlation * correlation)), 0.04) << dx << ' ' << dy;
  }
}

TEST(GaussianField, HeightsAreNormallyDistributed) {
  double second = 0, third = 0, fourth = 0;
  constexpr int fields = 16;
  for (uint64_t s = 0; s < fields; ++s) {
    for (const double h : gaussian_field(128, 3, 7, s)) {
      second += h * h;
      third += h * h * h;
      fourth += h * h * h * h;
    }
  }
  constexpr double count = 128.0 * 128.0 * fields;
  second /= count;
  EXPECT_NEAR(third / count / std::pow(second, 1.5), 0, 0.06);
  EXPECT_NEAR(fourth / count / (second * second), 3, 0.12);
}

TEST(GaussianField, IsAPureFunctionOfSeedAndStream) {
  EXPECT_EQ(gaussian_field(64, 4, 1, 2), gaussian_field(64, 4, 1, 2));
  EXPECT_NE(gaussian_field(64, 4, 1, 2), gaussian_field(64, 4, 1, 3));
  EXPECT_NE(gaussian_field(64, 4, 1, 2), gaussian_field(64, 4, 2, 2));
}

TEST(HeightField, FacetSlopesHaveTheRoughnessAskedFor) {
  for (const double anisotropy : {1.0, 4.0}) {
    const double alpha = 0.3;
    double x_sq = 0, y_sq = 0, x_fourth = 0, cross = 0;
    constexpr int fields = 16;
    for (uint64_t s = 0; s < fields; ++s) {
      const HeightField field = make_height_field({256, 8, alpha, anisotropy}, 5, s);
      for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
          const double along_x = static_cast<double>(field.at(x + 1, y) - field.at(x, y));
          const double along_y = static_cast<double>(field.at(x, y + 1) - field.at(x, y)) / field.cell_y;
          x_sq += along_x * along_x;
          y_sq += along_y * along_y;
          x_fourth += std::pow(along_x, 4);
          cross += along_x * along_y;
        }
      }
    }
    constexpr double count = 256.0 * 256.0 * fields;
    const double alpha_y = alpha / anisotropy;
    EXPECT_NEAR(std::sqrt(2 * x_sq / count), alpha, 0.01 * alpha);
    EXPECT_NEAR(std::sqrt(2 * y_sq / count), alpha_y, 0.01 * alpha_y);
    // The roughness of all facets together, along both axes, is exact.
    EXPECT_NEAR((x_sq / (alpha * alpha) + y_sq / (alpha_y * alpha_y)) / count, 1, 1e-5);
    EXPECT_NEAR(x_fourth * count / (x_sq * x_sq), 3, 0.1);
    EXPECT_NEAR(cross / std::sqrt(x_sq * y_sq), 0, 0.02);
  }
}

TEST(Patches, CoverTheirShareExactly) {
  for (const double share : {0.0, 0.25, 0.5, 1.0}) {
    const std::vector<uint8_t> patches = make_patches(64, 8, share, 1, 9);
    EXPECT_EQ(std::count(patches.begin(), patches.end(), 1), std::lround(share * 64 * 64));
  }
  // Patches, not noise: a marked cell's neighbor is marked far more often than the share says.
  const std::vector<uint8_t> patches = make_patches(64, 8, 0.5, 1, 9);
  int both = 0;
  for (size_t i = 0; i + 1 < patches.size(); ++i) both += patches[i] & patches[i + 1];
  EXPECT_GT(both, 1700);
}

}  // namespace
}  // namespace velour::height_field_test
