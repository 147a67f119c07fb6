#include "support/chi_square.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <numeric>

#include "math/sphere/random.h"
#include "support/artifacts.h"

namespace velour::test {

namespace {

std::vector<double> count_samples(const SphereCells& cells, const std::function<Vec3(const Vec2&)>& sample,
                                  const ChiSquareOptions& options, ChiSquareResult& result) {
  std::vector<double> counts(cells.count(), 0.0);
  for (int64_t i = 0; i < options.samples; ++i) {
    const Vec3 w = sample(RandomStream(options.seed, 0, static_cast<uint64_t>(i)).next2());
    if (std::abs(glm::length(w) - 1) < 1e-4f) {
      ++counts[cells.find(w)];
    } else if (options.may_fail && w == Vec3(0)) {
      ++result.failed;
    } else {
      result.problem = "a sample is not a unit direction";
    }
  }
  return counts;
}

/// Adds up the terms of the statistic; cells are joined, smallest first, until each group expects enough.
void add_terms(double minimum, ChiSquareResult& result) {
  std::vector<size_t> order(result.observed.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return result.expected[a] < result.expected[b]; });
  double pooled_observed = 0, pooled_expected = 0;
  int groups = 0;
  const auto add_group = [&] {
    const double difference = pooled_observed - pooled_expected;
    result.statistic += difference * difference / pooled_expected;
    pooled_observed = pooled_expected = 0;
    ++groups;
  };
  for (const size_t i : order) {
    pooled_observed += result.observed[i];
    pooled_expected += result.expected[i];
    if (pooled_expected < minimum) continue;
    add_group();
  }
  if (result.options.may_fail) {
    pooled_observed += result.failed;
    pooled_expected += std::max(0.0, 1 - result.density_mass) * static_cast<double>(result.options.samples);
    if (pooled_expected >= minimum) add_group();
  }
  result.degrees_of_freedom = groups - 1;
}

void check_empty_cells(ChiSquareResult& result) {
  double strays = 0;
  for (size_t i = 0; i < result.observed.size(); ++i) strays += result.expected[i] == 0 ? result.observed[i] : 0;
  if (strays > 1e-5 * static_cast<double>(result.options.samples)) {
    result.problem = "samples fall where the density is 0";
  }
}

}  // namespace

ChiSquareResult chi_square(const std::function<Vec3(const Vec2&)>& sample,
                           const std::function<double(const Vec3&)>& pdf, const ChiSquareOptions& options) {
  ChiSquareResult result;
  result.options = options;
  const SphereCells cells(options);
  const auto samples = static_cast<double>(options.samples);
  result.observed = count_samples(cells, sample, options, result);
  const CellMasses masses = integrate_cells(cells, pdf, samples, options.refinements);
  for (const double mass : masses.mass) {
    result.density_mass += mass;
    result.expected.push_back(mass * samples);
  }
  if (!masses.problem.empty()) {
    result.problem = masses.problem;
    return result;
  }
  if (result.density_mass > 1.005) result.problem = "the density integrates to more than 1";
  check_empty_cells(result);
  add_terms(options.minimum_expected, result);
  result.p_value = result.degrees_of_freedom > 0 ? chi_square_tail(result.statistic, result.degrees_of_freedom) : 1.0;
  return result;
}

::testing::AssertionResult follows_density(const ChiSquareResult& result, double level, const std::string& name,
                                           double mass_tolerance) {
  const double reached = 1 - result.failed / static_cast<double>(result.options.samples);
  const bool has_mass = std::abs(result.density_mass - reached) <= mass_tolerance;
  if (result.problem.empty() && result.p_value > level && has_mass) return ::testing::AssertionSuccess();
  const auto path = artifact_path(name + ".cells.csv");
  write_cells(path, result);
  return ::testing::AssertionFailure() << name << ": p " << result.p_value << " at level " << level << ", chi-square "
                                       << result.statistic << " of " << result.degrees_of_freedom
                                       << " degrees of freedom, mass of the density " << result.density_mass
                                       << " where 1 less the failed samples is " << reached << ", seed "
                                       << result.options.seed
                                       << (result.problem.empty() ? "" : ", problem: " + result.problem)
                                       << "; cells in " << path.string();
}

void write_cells(const std::filesystem::path& path, const ChiSquareResult& result) {
  const SphereCells cells(result.options);
  std::ofstream file(path);
  file.precision(9);
  file << "d0,d1,phi0,phi1,observed,expected,normalized_difference\n";
  const auto columns = static_cast<size_t>(cells.columns());
  for (size_t i = 0; i < result.observed.size(); ++i) {
    const int column = static_cast<int>(i % columns);
    const double difference = result.observed[i] - result.expected[i];
    file << cells.edge(i / columns) << ',' << cells.edge(i / columns + 1) << ',' << cells.phi_edge(column) << ','
         << cells.phi_edge(column + 1) << ',' << result.observed[i] << ',' << result.expected[i] << ','
         << (difference == 0 ? 0 : difference / std::sqrt(result.expected[i])) << '\n';
  }
}

double smallest_bandwidth_error(int64_t samples, int cells, double level) {
  const double degrees = cells - 1, inf = std::numeric_limits<double>::infinity();
  // One-sided: the statistic errs upwards. Its variance is 2 (degrees + 2 shift).
  const double threshold = student_quantile(2 * level, inf) * std::sqrt(2 * degrees);
  const double sure = student_quantile(0.02, inf);
  double shift = threshold;
  for (int i = 0; i < 100; ++i) shift = threshold + sure * std::sqrt(2 * (degrees + 2 * shift));
  return std::sqrt(shift / static_cast<double>(samples));
}

}  // namespace velour::test
