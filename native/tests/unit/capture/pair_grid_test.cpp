#include "capture/goniometer/bins.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "math/sphere/random.h"
#include "math/sphere/warp.h"

namespace velour::pair_grid_test {
namespace {

DirectionPair random_pair(uint64_t i) {
  RandomStream random(11, 0, i);
  return {sample_uniform_hemisphere(random.next2()), sample_uniform_hemisphere(random.next2())};
}

Vec3 mirrored_y(const Vec3& w) { return {w.x, -w.y, w.z}; }
Vec3 mirrored_x(const Vec3& w) { return {-w.x, w.y, w.z}; }

const PairGrid kGrids[] = {PairGrid(6, 5, 0), PairGrid(4, 3, 6)};

TEST(PairGrid, SharesAddUpToOne) {
  for (const PairGrid& grid : kGrids) {
    for (uint64_t i = 0; i < 2000; ++i) {
      const PairGrid::Stencil s = grid.stencil(random_pair(i));
      float sum = 0;
      for (int k = 0; k < s.count; ++k) {
        ASSERT_LT(s.node[static_cast<size_t>(k)], grid.size());
        ASSERT_GE(s.share[static_cast<size_t>(k)], 0.0f);
        sum += s.share[static_cast<size_t>(k)];
      }
      ASSERT_NEAR(sum, 1, 1e-6);
    }
  }
}

TEST(PairGrid, HoldsTheCornersOfItsDomain) {
  for (const PairGrid& grid : kGrids) {
    for (const Vec3& a : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, -1, 0)}) {
      for (const Vec3& b : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(-1, -0.0f, 0)}) {
        const PairGrid::Stencil s = grid.stencil({a, b});
        for (int k = 0; k < s.count; ++k) EXPECT_LT(s.node[static_cast<size_t>(k)], grid.size());
      }
    }
  }
}

// Draws as the goniometer does, every light with the flux of f = 1: each bin must then hold its measure.
TEST(PairGrid, FluxMeasureIsWhatDrawsOfUnitReflectanceCollect) {
  constexpr int draws = 400'000;
  for (const PairGrid& grid : kGrids) {
    for (const bool exchanged : {false, true}) {
      std::vector<double> sums(grid.size(), 0.0);
      for (uint64_t i = 0; i < draws; ++i) {
        RandomStream random(2, 3, i);
        const Vec2 u = random.next2();
        const Vec3 wv = direction(0.5f * kPi * u.x, 2 * kPi * u.y), wl = sample_cosine_hemisphere(random.next2());
        deposit(grid.stencil(exchanged ? DirectionPair{wv, wl} : DirectionPair{wl, wv}), kPiD, sums);
      }
      const std::vector<double> measure = grid.flux_measure(exchanged);
      double chi_sq = 0;
      for (size_t i = 0; i < grid.size(); ++i) {
        // Shares are at most 1: the variance of a sum is at most its mean times pi.
        chi_sq += std::pow(sums[i] - draws * measure[i], 2) / (kPiD * draws * measure[i]);
      }
      EXPECT_LT(chi_sq / static_cast<double>(grid.size()), 1.0);
      EXPECT_NEAR(std::accumulate(measure.begin(), measure.end(), 0.0), kPiD, 1e-9);
    }
  }
}

TEST(PairGrid, AWrongMeasureWouldBeNoticed) {  // control of the test above
  const std::vector<double> plain = kGrids[0].flux_measure(false), exchanged = kGrids[0].flux_measure(true);
  double chi_sq = 0;
  for (size_t i = 0; i < plain.size(); ++i) chi_sq += 4e5 * std::pow(plain[i] - exchanged[i], 2) / (kPiD * plain[i]);
  EXPECT_GT(chi_sq / static_cast<double>(plain.size()), 100.0);
}

TEST(PairGrid, PoolingMakesMirrorImagesEqual) {
  const PairGrid& grid = kGrids[1];
  std::vector<double> sums(grid.size());
  for (size_t i = 0; i < sums.size(); ++i) sums[i] = static_cast<double>(mix64(i) % 1000);
  const double before = std::accumulate(sums.begin(), sums.end(), 0.0);
  grid.pool_by_symmetry(sums, 1);
  EXPECT_NEAR(std::accumulate(sums.begin(), sums.end(), 0.0), 4 * before, 1e-6);
  for (uint64_t i = 0; i < 500; ++i) {
    const DirectionPair pair = random_pair(i);
    const double value = look_up(grid.stencil(pair), sums);
    EXPECT_NEAR(value, look_up(grid.stencil({mirrored_y(pair.wl), mirrored_y(pair.wv)}), sums), 1e-2);
    EXPECT_NEAR(value, look_up(grid.stencil({mirrored_x(pair.wl), mirrored_x(pair.wv)}), sums), 1e-2);
  }
}

TEST(PairGrid, IsotropicPoolingForgetsTheAzimuthOfTheNormal) {
  const PairGrid& grid = kGrids[0];
  std::vector<double> sums(3 * grid.size());
  for (size_t i = 0; i < sums.size(); ++i) sums[i] = static_cast<double>(mix64(i) % 1000);
  grid.pool_by_symmetry(sums, 3);
  std::vector<double> green(grid.size());
  for (size_t i = 0; i < green.size(); ++i) green[i] = sums[3 * i + 1];
  const double value = look_up(grid.stencil({{0, 0, 1}, direction(0.7f, 0)}), green);
  const Vec3 nearly_normal = direction(1e-5f, 2.0f);
  EXPECT_NEAR(look_up(grid.stencil({nearly_normal, direction(0.7f, 0)}), green), value, 0.1);
}

TEST(PairGrid, CoarserBinsForgetAllAzimuths) {
  for (const PairGrid& grid : kGrids) {
    std::vector<double> sums(grid.size());
    for (size_t i = 0; i < sums.size(); ++i) sums[i] = static_cast<double>(mix64(i) % 1000);
    grid.pool_azimuths(sums);
    const double value = look_up(grid.stencil({direction(0.4f, 0.1f), direction(1.0f, 2.0f)}), sums);
    EXPECT_NEAR(look_up(grid.stencil({direction(0.4f, 3.0f), direction(1.0f, -2.5f)}), sums), value, 1e-3 * value);
  }
}

}  // namespace
}  // namespace velour::pair_grid_test
