// One-dimensional densities of the environment's table.
#include <algorithm>
#include <cmath>

#include "scene/equirectangular.h"

namespace velour {

double build_cells(const std::vector<double>& mass, float* cdf, uint32_t* guide) {
  const size_t cells = mass.size();
  double total = 0.0;
  for (double m : mass) total += m;
  double sum = 0.0;
  for (size_t i = 0; i < cells; ++i) {
    cdf[i] = static_cast<float>(total > 0.0 ? sum / total : static_cast<double>(i) / static_cast<double>(cells));
    sum += mass[i];
  }
  cdf[cells] = 1.0f;
  uint32_t cell = 0;
  for (size_t k = 0; k < cells; ++k) {
    const float u = static_cast<float>(k) / static_cast<float>(cells);
    while (cell + 1 < cells && cdf[cell + 1] <= u) ++cell;
    guide[k] = cell;
  }
  return total;
}

int find_cell(const float* cdf, const uint32_t* guide, int cells, float u) {
  int cell = static_cast<int>(guide[std::min(static_cast<int>(u * static_cast<float>(cells)), cells - 1)]);
  while (cell > 0 && cdf[cell] > u) --cell;  // u * cells may have been rounded up
  while (cell + 1 < cells && cdf[cell + 1] <= u) ++cell;
  return cell;
}

float invert_linear(float a, float b, float u) {
  if (!(a + b > 0.0f) || u <= 0.0f) return u;
  // Root of a t + (b - a) t^2 / 2 = u (a + b) / 2 in the form without cancellation.
  const float root = std::sqrt((1.0f - u) * a * a + u * b * b);
  return std::min(u * (a + b) / (a + root), 1.0f);
}

}  // namespace velour
