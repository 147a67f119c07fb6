// Parametric materials drawn from without regard to horizon and cosine: what their densities are measured against.
#pragma once

#include <cmath>

#include "srbf/kernel.h"
#include "srbf/warped_mixture.h"

namespace velour::test {

/// Makes the density that of the lobes of f as they are, in proportion to luminance times integral over psi, with a
/// defensive share of the cosine.
inline void draw_plain_lobes(WarpedMixture& m, double defensive_share = 0.05) {
  const auto integral = [&](int j) { return kernel_integral(Kernel::gaussian, static_cast<double>(m.bandwidth[j])); };
  const auto mass = [&](int j) { return static_cast<double>(luminance({m.r[j], m.g[j], m.b[j]})) * integral(j); };
  double total = 0, sum = 0;
  for (int j = 0; j < m.count; ++j) total += mass(j);
  m.sums[m.kSums - 1] = static_cast<float>(defensive_share);
  for (int j = 0; j < m.count; ++j) {
    m.draw_x[j] = m.x[j];
    m.draw_y[j] = m.y[j];
    m.draw_z[j] = m.z[j];
    m.draw_bandwidth[j] = m.bandwidth[j];
    sum += mass(j);
    m.draw_tail[j] = std::exp(-2 * m.bandwidth[j]);
    float* const up_to = m.sums + m.kSums + j;
    *up_to = static_cast<float>(defensive_share + (1 - defensive_share) * sum / total);
    m.density[j] = static_cast<float>(static_cast<double>(up_to[0] - up_to[-1]) / integral(j));
  }
}

}  // namespace velour::test
