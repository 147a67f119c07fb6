// Gauss-Legendre quadrature.
#pragma once

#include <vector>

namespace velour {

struct Quadrature {
  std::vector<double> node;    // in (a, b), increasing
  std::vector<double> weight;  // positive, sum b - a
};

/// Exact for polynomials of degree 2n - 1 on [a, b].
Quadrature gauss_legendre(int n, double a, double b);

}  // namespace velour
