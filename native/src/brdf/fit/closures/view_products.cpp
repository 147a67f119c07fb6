#include "brdf/fit/closures/view_products.h"

#include <cmath>

namespace velour {

namespace {

ClosureLobeShape shape_of(const ClosureShape& s, LobeDistribution distribution, LobeMasking masking, double theta_v) {
  const double stretch = std::exp(s.anisotropy);
  return {.distribution = distribution,
          .masking = masking,
          .alpha_x = static_cast<float>(s.alpha * stretch),
          .alpha_y = static_cast<float>(s.alpha / stretch),
          .tilt = static_cast<float>(s.tilt * theta_v)};
}

LobeChain chain_of(const ClosureShape& s, double theta_v) {
  const auto stretch = static_cast<float>(s.anisotropy_by_anisotropy);
  return {.alpha_x = static_cast<float>(s.log_alpha_by_alpha + s.anisotropy_by_alpha),
          .alpha_y = static_cast<float>(s.log_alpha_by_alpha - s.anisotropy_by_alpha),
          .tilt = static_cast<float>(theta_v * s.tilt_by_tilt),
          .stretch_x = stretch,
          .stretch_y = -stretch};
}

}  // namespace

ViewProducts::ViewProducts(const ClosureTarget& target_at_view, const std::vector<LobeDistribution>& distributions,
                           LobeMasking masking, const ClosureBounds& bounds, const ViewUnknowns& u, bool slopes)
    : rows_per_lobe(slopes ? kSlopeRows : 1) {
  const ClosureLights& lights = target_at_view.lights;
  const size_t padded = lights.padded();
  const auto theta_v = static_cast<double>(lights.theta_v());
  rows = 1 + rows_per_lobe * static_cast<int>(distributions.size());
  AlignedArray<float> data(static_cast<size_t>(rows) * padded);
  for (size_t i = 0; i < padded; ++i) data.data()[i] = lights.wl_z()[i] * lights.root_weight()[i] * (1 / kPi);
  for (size_t k = 0; k < distributions.size(); ++k) {
    const int at = lobe_unknown(static_cast<int>(k));
    const ClosureShape s = closure_shape(u[at + 3], u[at + 4], u[at + 5], theta_v, bounds);
    const ClosureLobeShape shape = shape_of(s, distributions[k], masking, theta_v);
    float* out = data.data() + (1 + k * static_cast<size_t>(rows_per_lobe)) * padded;
    slopes ? fill_lobe_slopes(lights, shape, chain_of(s, theta_v), out) : fill_lobe(lights, shape, out);
  }
  const float* const fixed[4] = {target_at_view.channel(0), target_at_view.channel(1), target_at_view.channel(2),
                                 target_at_view.integral.data()};
  fill_products(data.data(), rows, padded, fixed, gram_, target);
}

}  // namespace velour
