#include "fit/stored_lobe.h"

#include <algorithm>
#include <cmath>

namespace velour {
namespace {

/// b of Abel-Poisson from 2/3 k = 2 b / (1 - b)^2, in a form without cancellation.
double abel_poisson_bandwidth(double sharpness) {
  const double c = 2.0 / 3.0 * sharpness;
  return c / (c + 1 + std::sqrt(2 * c + 1));
}

}  // namespace

StoredLobe stored_lobe(Kernel kernel, const SliceLobe& lobe) {
  double bandwidth = lobe.shape.sharpness;
  if (kernel == Kernel::abel_poisson) {
    // The largest float below 1 would make the kernel a spike; this bound is sharper than any grid of lights resolves.
    bandwidth = std::min(abel_poisson_bandwidth(lobe.shape.sharpness), 1 - 1e-6);
  }
  const auto rounded = static_cast<float>(bandwidth);
  const double peak = kernel_value(kernel, rounded, 0);
  return {Vec3(lobe.shape.center), rounded, Rgb(lobe.peak / peak)};
}

}  // namespace velour
