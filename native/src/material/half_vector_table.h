// A piecewise constant density of half vectors, tabulated from a material for one view.
#pragma once

#include <array>
#include <vector>

#include "material/material.h"

namespace velour {

/// The cells lie in half-vector space, where a highlight stays in place while the view moves. Their rows grow as the
/// fourth power from the normal, d = 1 - h.z = (row / 64)^4, where a highlight is narrow: lobes of 1e-3 rad are
/// resolved.
class HalfVectorTable {
 public:
  /// Mass of a cell = luminance(f) wl.z 4 wv.h, its density in h under the material at `wv`, averaged, times its solid
  /// angle. A black material gives cells of equal probability.
  void tabulate(const Material& material, const Vec3& wv);

  /// h on the upper hemisphere; `u_row`, `u_column` in [0, 1).
  Vec3 sample(double u_row, double u_column) const;
  /// Density of `sample` in the cell of h, per solid angle of h. All tables share their cells.
  struct Cell {
    size_t row, column;
    float inverse_solid_angle;
  };
  static Cell cell_of(const Vec3& h);  // h.z >= 0
  float pdf(const Cell& cell) const;

 private:
  static constexpr int kRows = 64, kColumns = 64;  // of d and of the azimuth of h
  using Masses = std::vector<double>;
  static float row_edge(int row);
  void add_row(const PreparedBrdf& point, const Material& material, int row, float d, Masses& mass) const;

  std::array<float, kRows> rows_;
  std::array<std::array<float, kColumns>, kRows> columns_;
};

}  // namespace velour
