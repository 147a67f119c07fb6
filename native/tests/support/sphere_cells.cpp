#include "support/sphere_cells.h"

#include <algorithm>
#include <cmath>

#include "math/sphere/frame.h"
#include "math/sphere/quadrature.h"

namespace velour::test {

namespace {

using Density = std::function<double(const Vec3&)>;

class CellIntegrator {
 public:
  CellIntegrator(const SphereCells& cells, const Density& density, double samples, const CellRefinements& refinements)
      : cells_(cells),
        density_(density),
        samples_(samples),
        refinements_(refinements),
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
    const bool settled = depth >= refinements_.least && std::abs(fine - coarse) <= tolerance;
    if (settled || depth >= refinements_.most || !problem_.empty()) return fine;
    double sum = 0;
    for (int i = 0; i < 4; ++i) sum += refine(parts[i], estimates[i], depth + 1);
    return sum;
  }

  const SphereCells& cells_;
  const Density& density_;
  double samples_;
  CellRefinements refinements_;
  Quadrature rule_;
  std::string problem_;
};

}  // namespace

SphereCells::SphereCells(const CellLayout& layout) : columns_(layout.columns) {
  const Frame frame = Frame::about(glm::normalize(layout.axis));
  x_ = Vec3d(frame.x), y_ = Vec3d(frame.y), z_ = glm::normalize(Vec3d(layout.axis));
  const int rows = layout.rows;
  const double innermost = std::min(0.01 / layout.concentration, 0.02);
  for (int i = 0; i <= rows; ++i) {
    const double uniform = 2.0 * i / rows;
    const double logarithmic = i == 0 ? 0 : 2 * std::pow(innermost / 2, static_cast<double>(rows - i) / (rows - 1));
    edges_.push_back(layout.concentration > 0 ? logarithmic : uniform);
  }
}

size_t SphereCells::find(const Vec3& w) const {
  const Vec3d from_axis = Vec3d(w) - z_;
  const double d = 0.5 * glm::dot(from_axis, from_axis);
  double turn = std::atan2(glm::dot(from_axis, y_), glm::dot(from_axis, x_)) / (2 * kPiD);
  if (turn < 0) turn += 1;
  const auto row = std::upper_bound(edges_.begin() + 1, edges_.end() - 1, d) - edges_.begin() - 1;
  const int column = std::min(static_cast<int>(turn * columns_), columns_ - 1);
  return static_cast<size_t>(row * columns_ + column);
}

Vec3 SphereCells::direction(double d, double phi) const {
  const double sine = std::sqrt(d * (2 - d));
  return Vec3(sine * std::cos(phi) * x_ + sine * std::sin(phi) * y_ + (1 - d) * z_);
}

CellMasses integrate_cells(const SphereCells& cells, const Density& density, double samples,
                           const CellRefinements& refinements) {
  CellIntegrator integrator(cells, density, samples, refinements);
  CellMasses result;
  for (size_t row = 0; row < cells.rows(); ++row) {
    for (int column = 0; column < cells.columns(); ++column) {
      result.mass.push_back(integrator.integrate(row, column));
    }
  }
  result.problem = integrator.problem();
  return result;
}

}  // namespace velour::test
