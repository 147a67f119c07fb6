// Chi-square of anything that samples wl for a fixed view.
#pragma once

#include <gtest/gtest.h>

#include "support/chi_square.h"
#include "support/materials.h"

namespace velour::test {

/// 0, 45, 80 and 89.5 degrees, at azimuths that meet no grid.
inline std::vector<Vec3> judged_views() {
  return {{0, 0, 1},
          direction(radians_from(45.0f), 0.7f),
          direction(radians_from(80.0f), -2.3f),
          direction(radians_from(89.5f), 3.0f)};
}

/// The sampler of one material against the density of another: the same one, or a negative control.
inline ChiSquareResult judge(const Material& sampled, const Material& claimed, const Vec3& wv,
                             const ChiSquareOptions& options) {
  PreparedBrdf sampled_point, claimed_point;
  sampled.prepare(wv, sampled_point);
  claimed.prepare(wv, claimed_point);
  return chi_square([&](const Vec2& u) { return sampled.sample(sampled_point, u); },
                    [&](const Vec3& wl) { return eval_one(claimed, claimed_point, wl).pdf; }, options);
}

inline ChiSquareOptions quick_options(uint64_t seed) {
  ChiSquareOptions options;
  options.samples = 200'000;
  options.seed = seed;
  return options;
}

/// The mass is known to the quadrature of a density that may jump within a cell.
inline void expect_accepted(const ChiSquareResult& result, double level, const std::string& what) {
  EXPECT_EQ(result.problem, "") << what;
  EXPECT_GT(result.p_value, level) << what;
  EXPECT_NEAR(result.density_mass, 1, 4e-3) << what;
}

}  // namespace velour::test
