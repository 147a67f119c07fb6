// Samplers made of lobes, and the cells that resolve them.
#pragma once

#include "math/srbf/lobe_mixture.h"
#include "support/mixtures.h"
#include "support/sampler_proof.h"

namespace velour::test {

/// Bandwidth of the Gaussian that is as wide as the kernel.
inline double gaussian_sharpness(Kernel kernel, double bandwidth) {
  return kernel == Kernel::gaussian ? bandwidth : bandwidth / ((1 - bandwidth) * (1 - bandwidth));
}

/// Cells about lobe `j`, where it is narrow enough to need them.
inline void resolve_lobe(const LobeMixture& mixture, int j, Sampler& sampler) {
  const double sharpness = gaussian_sharpness(mixture.kernel, static_cast<double>(mixture.bandwidth[j]));
  sampler.axis = {mixture.x[j], mixture.y[j], mixture.z[j]};
  sampler.concentration = sharpness > 3 ? sharpness : 0;
}

inline int sharpest_lobe(const LobeMixture& mixture) {
  int sharpest = 0;
  for (int j = 1; j < mixture.count; ++j) {
    if (mixture.bandwidth[j] > mixture.bandwidth[sharpest]) sharpest = j;
  }
  return sharpest;
}

inline double mixture_density(const LobeMixture& mixture, const Vec3& w) {
  ScalarBatch pdf;
  eval_density(mixture, batch_of({&w, 1}), pdf);
  return static_cast<double>(pdf.v[0]);
}

/// sample_mixture and eval_density in cells about the sharpest lobe.
inline Sampler mixture_sampler(const LobeMixture& mixture) {
  Sampler sampler{[mixture](const Vec2& u) { return sample_mixture(mixture, u); },
                  [mixture](const Vec3& w) { return mixture_density(mixture, w); }};
  if (mixture.count > 0) resolve_lobe(mixture, sharpest_lobe(mixture), sampler);
  return sampler;
}

}  // namespace velour::test
