#include "math/sphere/quadrature.h"

#include <cmath>

#include "math/sphere/vec.h"

namespace velour {

Quadrature gauss_legendre(int n, double a, double b) {
  Quadrature q{std::vector<double>(static_cast<size_t>(n)), std::vector<double>(static_cast<size_t>(n))};
  for (int i = 0; i < n; ++i) {
    double x = -std::cos(kPiD * (i + 0.75) / (n + 0.5));  // Tricomi's initial guess; Newton converges in a few steps
    double derivative = 1.0;
    for (int step = 0; step < 100; ++step) {
      double p0 = 1.0, p1 = x;
      for (int k = 2; k <= n; ++k) {
        const double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
        p0 = p1;
        p1 = p2;
      }
      derivative = n * (x * p1 - p0) / (x * x - 1.0);
      const double change = p1 / derivative;
      x -= change;
      if (std::abs(change) < 1e-15) break;
    }
    const size_t at = static_cast<size_t>(i);
    q.node[at] = 0.5 * (a + b) + 0.5 * (b - a) * x;
    q.weight[at] = (b - a) / ((1.0 - x * x) * derivative * derivative);
  }
  return q;
}

}  // namespace velour
