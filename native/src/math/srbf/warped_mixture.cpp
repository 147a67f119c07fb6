#include "math/srbf/warped_mixture.h"

#include <algorithm>
#include <cmath>

#include "math/srbf/kernel.h"

namespace velour {

void draw_plain_lobes(WarpedMixture& m, float cosine) {
  double integral[WarpedMixture::kCapacity], mass[WarpedMixture::kCapacity], total = 0;
  for (int j = 0; j < m.count; ++j) {
    integral[j] = kernel_integral(Kernel::gaussian, std::max(static_cast<double>(m.bandwidth[j]), kMinMeanBandwidth));
    mass[j] = static_cast<double>(std::max(luminance({m.r[j], m.g[j], m.b[j]}), 0.0f)) * integral[j];
    total += mass[j];
  }
  const float share = total > 0 ? cosine : 1.0f;
  float* const sums = m.sums + m.kSums;
  sums[-2] = 0;
  sums[-1] = share;
  double sum = 0;
  for (int j = 0; j < m.padded; ++j) {
    const bool is_there = j < m.count && total > 0;
    m.draw_x[j] = j < m.count ? m.x[j] : 0.0f;
    m.draw_y[j] = j < m.count ? m.y[j] : 0.0f;
    m.draw_z[j] = j < m.count ? m.z[j] : 1.0f;
    m.draw_bandwidth[j] = j < m.count ? std::max(m.bandwidth[j], static_cast<float>(kMinMeanBandwidth)) : 1.0f;
    m.draw_tail[j] = std::exp(-2 * m.draw_bandwidth[j]);
    if (is_there) sum += mass[j] / total;
    sums[j] = j + 1 < m.count && is_there ? static_cast<float>(share + (1 - share) * sum) : 1.0f;
    m.density[j] = is_there ? static_cast<float>(static_cast<double>(sums[j] - sums[j - 1]) / integral[j]) : 0.0f;
  }
}

}  // namespace velour
