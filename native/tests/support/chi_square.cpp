#include "support/chi_square.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "sphere/frame.h"
#include "sphere/quadrature.h"
#include "sphere/random.h"

namespace velour::test {

namespace {

using Density = std::function<double(const Vec3&)>;

/// Cells in d = 1 - cos about an axis, in which solid angle is dd dphi, and the azimuth phi.
class Cells {
 public:
  explicit Cells(const ChiSquareOptions& options) : phi_cells_(options.phi_cells) {
    const Frame frame = Frame::about(glm::normalize(options.axis));
    x_ = Vec3d(frame.x), y_ = Vec3d(frame.y), z_ = glm::normalize(Vec3d(options.axis));
    const int rows = options.cos_theta_cells;
    const double innermost = std::min(0.01 / options.concentration, 0.02);
    for (int i = 0; i <= rows; ++i) {
      const double uniform = 2.0 * i / rows;
      const double logarithmic = i == 0 ? 0 : 2 * std::pow(innermost / 2, static_cast<double>(rows - i) / (rows - 1));
      edges_.push_back(options.concentration > 0 ? logarithmic : uniform);
    }
  }

  size_t count() const { return (edges_.size() - 1) * static_cast<size_t>(phi_cells_); }
  size_t rows() const { return edges_.size() - 1; }
  int phi_cells() const { return phi_cells_; }
  double edge(size_t row) const { return edges_[row]; }
  double phi_edge(int column) const { return 2 * kPiD * column / phi_cells_; }

  size_t find(const Vec3& w) const {
    const Vec3d from_axis = Vec3d(w) - z_;
    const double d = 0.5 * glm::dot(from_axis, from_axis);
    double turn = std::atan2(glm::dot(from_axis, y_), glm::dot(from_axis, x_)) / (2 * kPiD);
    if (turn < 0) turn += 1;
    const auto row = std::upper_bound(edges_.begin() + 1, edges_.end() - 1, d) - edges_.begin() - 1;
    const int column = std::min(static_cast<int>(turn * phi_cells_), phi_cells_ - 1);
    return static_cast<size_t>(row * phi_cells_ + column);
  }

  Vec3 direction(double d, double phi) const {
    const double sine = std::sqrt(d * (2 - d));
    return Vec3(sine * std::cos(phi) * x_ + sine * std::sin(phi) * y_ + (1 - d) * z_);
  }

 private:
  int phi_cells_;
  Vec3d x_, y_, z_;
  std::vector<double> edges_;  // of d
};

/// Integrals of a density over cells by Gauss-Legendre quadrature, halved where one level disagrees with the next.
class CellIntegrator {
 public:
  CellIntegrator(const Cells& cells, const Density& density, const ChiSquareOptions& options)
      : cells_(cells),
        density_(density),
        samples_(static_cast<double>(options.samples)),
        refinements_(options.refinements),
        rule_(gauss_legendre(4, 0, 1)) {}

  double integrate(size_t row, int column) {
    const Box box{cells_.edge(row), cells_.edge(row + 1), cells_.phi_edge(column), cells_.phi_edge(column + 1)};
    return refine(box, estimate(box), 0);
  }

  const std::string& problem() const { return problem_; }

 private:
  struct Box {
    double d0, d1, phi0, phi1;
  };

  double estimate(const Box& box) {
    double sum = 0;
    for (size_t i = 0; i < rule_.node.size(); ++i) {
      for (size_t k = 0; k < rule_.node.size(); ++k) {
        const double d = box.d0 + rule_.node[i] * (box.d1 - box.d0);
        const double value = density_(cells_.direction(d, box.phi0 + rule_.node[k] * (box.phi1 - box.phi0)));
        if (!std::isfinite(value)) problem_ = "the density is not a finite number";
        if (value < 0) problem_ = "the density is negative";
        sum += rule_.weight[i] * rule_.weight[k] * value;
      }
    }
    return sum * (box.d1 - box.d0) * (box.phi1 - box.phi0);
  }

  double refine(const Box& box, double coarse, int depth) {
    const double d = 0.5 * (box.d0 + box.d1), phi = 0.5 * (box.phi0 + box.phi1);
    const Box parts[4] = {
        {box.d0, d, box.phi0, phi}, {box.d0, d, phi, box.phi1}, {d, box.d1, box.phi0, phi}, {d, box.d1, phi, box.phi1}};
    double estimates[4], fine = 0;
    for (int i = 0; i < 4; ++i) fine += estimates[i] = estimate(parts[i]);
    // A small part of the count's own standard deviation.
    const double tolerance = 0.002 * std::sqrt(std::max(fine, 1 / samples_) / samples_);
    if (depth == refinements_ || std::abs(fine - coarse) <= tolerance || !problem_.empty()) return fine;
    double sum = 0;
    for (int i = 0; i < 4; ++i) sum += refine(parts[i], estimates[i], depth + 1);
    return sum;
  }

  const Cells& cells_;
  const Density& density_;
  double samples_;
  int refinements_;
  Quadrature rule_;
  std::string problem_;
};

std::vector<double> count_samples(const Cells& cells, const std::function<Vec3(const Vec2&)>& sample,
                                  const ChiSquareOptions& options, std::string& problem) {
  std::vector<double> counts(cells.count(), 0.0);
  for (int64_t i = 0; i < options.samples; ++i) {
    const Vec3 w = sample(RandomStream(options.seed, 0, static_cast<uint64_t>(i)).next2());
    if (std::abs(glm::length(w) - 1) < 1e-4f) {
      ++counts[cells.find(w)];
    } else {
      problem = "a sample is not a unit direction";
    }
  }
  return counts;
}

/// Adds up the terms of the statistic; cells are joined, smallest first, until each group expects enough.
void add_terms(const std::vector<double>& observed, const std::vector<double>& expected, double minimum,
               ChiSquareResult& result) {
  std::vector<size_t> order(observed.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return expected[a] < expected[b]; });
  double pooled_observed = 0, pooled_expected = 0;
  int groups = 0;
  for (const size_t i : order) {
    pooled_observed += observed[i];
    pooled_expected += expected[i];
    if (pooled_expected < minimum) continue;
    const double difference = pooled_observed - pooled_expected;
    result.statistic += difference * difference / pooled_expected;
    pooled_observed = pooled_expected = 0;
    ++groups;
  }
  result.degrees_of_freedom = groups - 1;
}

void check_empty_cells(const std::vector<double>& observed, const std::vector<double>& expected, double samples,
                       std::string& problem) {
  double strays = 0;
  for (size_t i = 0; i < observed.size(); ++i) strays += expected[i] == 0 ? observed[i] : 0;
  if (strays > 1e-5 * samples) problem = "samples fall where the density is 0";
}

}  // namespace

double sidak_level(double level, int tests) { return -std::expm1(std::log1p(-level) / tests); }

double chi_square_tail(double statistic, int degrees_of_freedom) {
  const double a = 0.5 * degrees_of_freedom, x = 0.5 * statistic;
  if (x <= 0) return 1;
  const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1) {  // series of the lower function, then its complement
    double term = 1 / a, sum = term;
    for (double n = a + 1; term > 1e-16 * sum; ++n) sum += term *= x / n;
    return std::max(0.0, 1 - front * sum);
  }
  // Continued fraction of the upper function, by Lentz's method.
  double b = x + 1 - a, c = 1e300, d = 1 / b, fraction = d;
  for (int i = 1; i < 10000; ++i) {
    const double numerator = -i * (i - a);
    b += 2;
    d = 1 / (numerator * d + b);
    c = b + numerator / c;
    fraction *= c * d;
    if (std::abs(c * d - 1) < 1e-15) break;
  }
  return front * fraction;
}

ChiSquareResult chi_square(const std::function<Vec3(const Vec2&)>& sample,
                           const std::function<double(const Vec3&)>& pdf, const ChiSquareOptions& options) {
  ChiSquareResult result;
  const Cells cells(options);
  const auto samples = static_cast<double>(options.samples);
  const std::vector<double> observed = count_samples(cells, sample, options, result.problem);
  std::vector<double> expected;
  CellIntegrator integrator(cells, pdf, options);
  for (size_t row = 0; row < cells.rows(); ++row) {
    for (int column = 0; column < cells.phi_cells(); ++column) {
      const double mass = integrator.integrate(row, column);
      result.density_mass += mass;
      expected.push_back(mass * samples);
    }
  }
  if (!integrator.problem().empty()) {
    result.problem = integrator.problem();
    return result;
  }
  if (result.density_mass > 1.005) result.problem = "the density integrates to more than 1";
  check_empty_cells(observed, expected, samples, result.problem);
  add_terms(observed, expected, options.minimum_expected, result);
  result.p_value = result.degrees_of_freedom > 0 ? chi_square_tail(result.statistic, result.degrees_of_freedom) : 1.0;
  return result;
}

}  // namespace velour::test
