// Chi-square test of a sampler against its claimed density.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "sphere/vec.h"

namespace velour::test {

/// Level of each of `tests` tests so that the whole list has level `level` (Sidak).
double sidak_level(double level, int tests);

/// Probability that chi-square with `degrees_of_freedom` exceeds `statistic`: the regularised upper gamma function.
double chi_square_tail(double statistic, int degrees_of_freedom);

struct ChiSquareOptions {
  int cos_theta_cells = 51;  // odd: no cell edge lies on the horizon
  int phi_cells = 40;
  int64_t samples = 1'000'000;
  uint64_t seed = 1;
  double minimum_expected = 5;  // cells that expect less are pooled
  int refinements = 6;          // halvings of a cell at most, where its integral is not settled
  /// Axis of the cells' poles; put it on a sharp lobe so that the lobe is resolved: cells are uniform in log(1 - cos)
  /// about it when `concentration` > 0 (the lobe's bandwidth).
  Vec3 axis{0, 0, 1};
  double concentration = 0;
};

struct ChiSquareResult {
  double p_value = 0;
  double statistic = 0;
  int degrees_of_freedom = 0;
  double density_mass = 0;  // integral of the claimed density: must be 1 (or the stated mass)
  /// Not empty: density negative, not a number or of mass above 1.005; samples off the sphere or where the density is
  /// 0.
  std::string problem;
};

/// `sample(u)` returns a unit direction; `pdf(w)` its density per solid angle over the whole sphere.
ChiSquareResult chi_square(const std::function<Vec3(const Vec2&)>& sample,
                           const std::function<double(const Vec3&)>& pdf, const ChiSquareOptions& options = {});

}  // namespace velour::test
