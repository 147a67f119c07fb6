// Cells over the sphere, and the integral of a density over each.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "math/sphere/vec.h"

namespace velour::test {

/// What the cells are made of.
struct CellLayout {
  int rows = 51;  // of 1 - cos about the axis; odd: no cell edge lies on the horizon of even rows about the normal
  int columns = 40;
  /// Axis of the cells' poles; put it on a sharp lobe so that the lobe is resolved: rows are uniform in log(1 - cos)
  /// about it when `concentration` > 0 (the lobe's bandwidth).
  Vec3 axis{0, 0, 1};
  double concentration = 0;
};

/// Cells in d = 1 - cos about an axis, in which solid angle is dd dphi, and the azimuth phi. Row by row.
class SphereCells {
 public:
  explicit SphereCells(const CellLayout& layout);

  size_t count() const { return rows() * static_cast<size_t>(columns_); }
  size_t rows() const { return edges_.size() - 1; }
  int columns() const { return columns_; }
  double edge(size_t row) const { return edges_[row]; }
  double phi_edge(int column) const { return 2 * kPiD * column / columns_; }

  /// The cell of unit `w`.
  size_t find(const Vec3& w) const;
  Vec3 direction(double d, double phi) const;

 private:
  int columns_;
  Vec3d x_, y_, z_;
  std::vector<double> edges_;  // of d
};

struct CellMasses {
  std::vector<double> mass;
  std::string problem;  // not empty: the density is negative or not a number
};

/// How often a cell is halved both ways for its integral: at least so often, which finds what jumps inside a cell, and
/// further where one level disagrees with the next.
struct CellRefinements {
  int least = 0, most = 6;
};

/// Integral of `density` (per solid angle) over each cell, by Gauss-Legendre quadrature, known to a small part of the
/// deviation that `samples` counts have.
CellMasses integrate_cells(const SphereCells& cells, const std::function<double(const Vec3&)>& density, double samples,
                           const CellRefinements& refinements);

}  // namespace velour::test
