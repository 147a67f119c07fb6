// Networks of closures for tests.
#pragma once

#include <cmath>
#include <vector>

#include "brdf/fit/closures/closures.h"

namespace velour::test {

inline constexpr LobeDistribution kGgx = LobeDistribution::ggx, kBeckmann = LobeDistribution::beckmann;
inline constexpr LobeMasking kSeparable = LobeMasking::separable, kCorrelated = LobeMasking::height_correlated;

inline ClosureLobe lobe_of(LobeDistribution distribution, const Rgb& weight, float alpha, float tilt = 0,
                           float anisotropy = 0) {
  ClosureLobe lobe{.distribution = distribution};
  lobe.weight.fill(weight);
  lobe.roughness.fill(std::sqrt(alpha));
  lobe.tilt.fill(tilt);
  lobe.anisotropy.fill(anisotropy);
  return lobe;
}

inline ClosureNetwork network_of(const Rgb& diffuse, std::vector<ClosureLobe> lobes) {
  ClosureNetwork network;
  network.diffuse.fill(diffuse);
  network.lobes = std::move(lobes);
  return network;
}

/// Lights of weight 1.
inline ClosureLights plain_lights(float theta_v, const std::vector<Vec3>& wl, float phi_v = 0) {
  return {theta_v, {wl, std::vector<double>(wl.size(), 1.0)}, phi_v};
}

/// f cos at lights in the frame of the network.
inline std::vector<Rgb> values_of(const ClosureNetwork& network, LobeMasking masking, float theta_v,
                                  const std::vector<Vec3>& wl, float phi_v = 0) {
  const ClosureLights lights = plain_lights(theta_v, wl, phi_v);
  const AlignedArray<float> rows = closure_values(network, masking, lights);
  std::vector<Rgb> values;
  for (size_t i = 0; i < wl.size(); ++i) {
    values.push_back({rows.data()[i], rows.data()[lights.padded() + i], rows.data()[2 * lights.padded() + i]});
  }
  return values;
}

inline ClosureSource source_of(const ClosureNetwork& network, LobeMasking masking) {
  const bool isotropic = network.frame == ClosureFrame::incidence;
  return {[=](const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f) {
            const float phi = std::atan2(wv.y, wv.x), turn = isotropic ? phi : 0;
            const float c = std::cos(turn), s = std::sin(turn);
            std::vector<Vec3> turned;
            for (const Vec3& w : wl) turned.push_back({c * w.x + s * w.y, c * w.y - s * w.x, w.z});
            const float theta = std::atan2(std::hypot(wv.x, wv.y), wv.z);
            const std::vector<Rgb> values = values_of(network, masking, theta, turned, phi - turn);
            for (size_t i = 0; i < wl.size(); ++i) f[i] = wl[i].z > 0 ? values[i] / wl[i].z : Rgb(0);
          },
          isotropic};
}

}  // namespace velour::test
