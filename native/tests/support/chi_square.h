// Chi-square test of a sampler against its claimed density. Its one verdict is follows_density().
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>

#include "support/significance.h"
#include "support/sphere_cells.h"

namespace velour::test {

struct ChiSquareOptions : CellLayout {
  int64_t samples = 1'000'000;
  uint64_t seed = 1;
  double minimum_expected = 5;  // cells that expect less are pooled
  CellRefinements refinements{};
  /// The sampler may bring no direction, the zero vector: a cell of its own, which expects what the density's mass
  /// lacks of 1.
  bool may_fail = false;
};

struct ChiSquareResult {
  double p_value = 0;
  double statistic = 0;
  int degrees_of_freedom = 0;
  double density_mass = 0;  // integral of the claimed density: must be 1, less the share of samples that fail
  double failed = 0;        // samples without a direction
  /// Not empty: density negative, not a number or of mass above 1.005; samples off the sphere or where the density is
  /// 0.
  std::string problem;
  ChiSquareOptions options;
  std::vector<double> observed, expected;  // counts by cell, as SphereCells has them
};

/// `sample(u)` returns a unit direction; `pdf(w)` its density per solid angle over the whole sphere.
ChiSquareResult chi_square(const std::function<Vec3(const Vec2&)>& sample,
                           const std::function<double(const Vec3&)>& pdf, const ChiSquareOptions& options = {});

/// Success when there is no problem, the p-value is above `level`, and the density's mass is 1, less the share that
/// failed, within `mass_tolerance` (the quadrature of a density that may jump inside a cell). A failure writes the
/// table of cells as the artifact NAME.cells.csv, which the message names.
::testing::AssertionResult follows_density(const ChiSquareResult& result, double level, const std::string& name,
                                           double mass_tolerance = 4e-3);

/// A line a cell: its edges (d0, d1: 1 - cos from the axis; phi0, phi1: radians), counts observed and expected, and
/// their difference over the root of the expected count.
void write_cells(const std::filesystem::path& path, const ChiSquareResult& result);

/// The relative error of the bandwidth of a narrow Gaussian lobe about the cells' axis that a test of `cells` cells
/// and `samples` samples rejects at `level` in 99 of 100 seeds. A relative change e of the bandwidth moves the
/// statistic by samples e^2, since the variance of lambda d is 1; the statistic is taken as normal.
double smallest_bandwidth_error(int64_t samples, int cells, double level);

}  // namespace velour::test
