#include "scene/piecewise_linear.h"

namespace velour {

double build_cells(const std::vector<double>& mass, float* cdf, uint16_t* guide) {
  const size_t cells = mass.size();
  double total = 0.0;
  for (double m : mass) total += m;
  double sum = 0.0;
  for (size_t i = 0; i < cells; ++i) {
    cdf[i] = static_cast<float>(total > 0.0 ? sum / total : static_cast<double>(i) / static_cast<double>(cells));
    sum += mass[i];
  }
  cdf[cells] = 1.0f;
  size_t cell = 0;
  for (size_t k = 0; k < cells; ++k) {
    const float u = static_cast<float>(k) / static_cast<float>(cells);
    while (cell + 1 < cells && cdf[cell + 1] <= u) ++cell;
    guide[k] = static_cast<uint16_t>(cell);
  }
  return total;
}

}  // namespace velour
