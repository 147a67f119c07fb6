#include "brdf/fit/closures/closures.h"

#include <algorithm>
#include <cmath>

namespace velour {

float lowest_closure_tilt(float theta_v) {
  constexpr float kMinRise = 0.01f;
  const float rise = std::min(0.9f * std::cos(theta_v), kMinRise);
  return 0.5f * (theta_v - std::acos(std::clamp(rise, 0.0f, 1.0f)));
}

namespace {

/// Value of a curve at theta_v, held at the ends.
template <class T>
T closure_value(const ClosureCurve<T>& curve, float theta_v) {
  const float at = std::clamp(theta_v / (0.5f * kPi), 0.0f, 1.0f) * (kClosureSamples - 1);
  const size_t i = std::min(static_cast<size_t>(at), static_cast<size_t>(kClosureSamples - 2));
  const float t = at - static_cast<float>(i);
  return curve[i] * (1 - t) + curve[i + 1] * t;
}

ClosureLobeShape shape_at(const ClosureLobe& lobe, LobeMasking masking, float theta_v) {
  const float roughness = closure_value(lobe.roughness, theta_v), alpha = roughness * roughness;
  const float stretch = std::exp(closure_value(lobe.anisotropy, theta_v));
  return {.distribution = lobe.distribution,
          .masking = masking,
          .alpha_x = std::min(alpha * stretch, 1.0f),
          .alpha_y = std::min(alpha / stretch, 1.0f),
          .tilt = closure_value(lobe.tilt, theta_v) * theta_v};
}

}  // namespace

AlignedArray<float> closure_values(const ClosureNetwork& network, LobeMasking masking, const ClosureLights& lights) {
  const size_t row = lights.padded();
  AlignedArray<float> values(3 * row), lobe(row);
  const auto color_at = [&](const ClosureCurve<Rgb>& curve) { return closure_value(curve, lights.theta_v()); };
  const Rgb diffuse = color_at(network.diffuse) / kPi;
  for (int c = 0; c < 3; ++c) {
    float* out = values.data() + static_cast<size_t>(c) * row;
    for (size_t i = 0; i < row; ++i) out[i] = diffuse[c] * lights.wl_z()[i] * lights.root_weight()[i];
  }
  for (const ClosureLobe& l : network.lobes) {
    fill_lobe(lights, shape_at(l, masking, lights.theta_v()), lobe.data());
    const Rgb weight = color_at(l.weight);
    for (int c = 0; c < 3; ++c) {
      float* out = values.data() + static_cast<size_t>(c) * row;
      for (size_t i = 0; i < row; ++i) out[i] += weight[c] * lobe.data()[i];
    }
  }
  return values;
}

float incoming_factor(float tilt, float theta_v) {
  if (theta_v < 1e-3f) return tilt;
  const float across = std::tan(tilt * theta_v);
  return across / (std::sin(theta_v) + across * (1 - std::cos(theta_v)));
}

float anisotropy_input(float anisotropy) {
  return anisotropy < 0 ? 1 - std::exp(anisotropy) : std::exp(-anisotropy) - 1;
}

}  // namespace velour
