// What every sampler must show, whatever it samples: one call a case of a parametrised list.
#pragma once

#include "support/chi_square.h"

namespace velour::test {

/// A sampler, the density that it claims, and cells that resolve it (CellLayout).
struct Sampler {
  std::function<Vec3(const Vec2&)> sample;
  std::function<double(const Vec3&)> pdf;  // per solid angle over the whole sphere
  Vec3 axis{0, 0, 1};
  double concentration = 0;
  CellRefinements refinements{};
  bool may_fail = false;  // ChiSquareOptions
};

/// 200,000 samples in 25 x 16 cells: in a list of 135, a bandwidth off by 3.2 % is rejected in 99 of 100 cases
/// (smallest_bandwidth_error, which the tests of the harness hold against experiment).
ChiSquareOptions proof_options(const Sampler& sampler);

/// Chi-square at the level that the running suite leaves to each of its tests, seeded by the test's name; and random
/// numbers at 0 and at the last float below 1, alone and together, that must give unit directions of finite density.
void expect_proven(const Sampler& sampler, const std::string& name);

/// For negative controls: p-value of samples of one under the density of another, in the cells of the first.
double p_value(const Sampler& sampled, const Sampler& claimed);

/// Polar angles of the view, degrees, that every sampler which depends on the view is judged at.
inline const std::vector<float> kViewAngles = {0, 15, 30, 45, 60, 75, 85, 89, 89.5f};
/// Their directions, at an azimuth that meets no grid.
Vec3 view_at(float degrees);

}  // namespace velour::test
