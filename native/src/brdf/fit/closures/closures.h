// A BRDF as nodes of Blender: a Diffuse BSDF and up to three Glossy BSDFs whose colors and shapes are curves over the
// view angle.
#pragma once

#include <array>
#include <vector>
#include "base/aligned_array.h"
#include "brdf/fit/closures/closure_lights.h"
#include "brdf/fit/closures/lobe_columns.h"
#include "math/sphere/vec.h"

namespace velour {

/// Samples of a curve at theta_v = 90 degrees * i / (kClosureSamples - 1), linear between them.
inline constexpr int kClosureSamples = 65;
template <class T>
using ClosureCurve = std::array<T, kClosureSamples>;

/// One Glossy BSDF. Its normal N' is turned by tilt * theta_v in the plane of incidence: 1 points it at the viewer,
/// negative values away from it. Its alpha is roughness^2 e^anisotropy along the plane of incidence, and
/// roughness^2 e^-anisotropy across it; both are at most 1.
struct ClosureLobe {
  LobeDistribution distribution = LobeDistribution::ggx;
  ClosureCurve<Rgb> weight{};       // not negative; may exceed 1
  ClosureCurve<float> roughness{};  // square root of alpha, in (0, 1]
  ClosureCurve<float> tilt{};       // in [-1, 1]
  ClosureCurve<float> anisotropy{};
};

struct ClosureNetwork {
  ClosureCurve<Rgb> diffuse{};  // albedo of the Diffuse BSDF, not negative
  std::vector<ClosureLobe> lobes;
};

/// Smallest angle (radians, negative) by which Cycles lets a normal turn toward the viewer at `theta_v` in
/// [0, pi / 2]: the mirror direction about N' must stay above the surface (ensure_valid_reflection).
float lowest_closure_tilt(float theta_v);

/// f cos(theta_l) in 1/sr at the lights, which lie above the horizon, times root_weight. A row per channel.
AlignedArray<float> closure_values(const ClosureNetwork& network, LobeMasking masking, const ClosureLights& lights);

// Values of inputs of Blender's nodes.

/// Factor s of N' = normalize(N + s (Incoming - N)) for the relative `tilt` of a lobe, at theta_v < pi / 2.
float incoming_factor(float tilt, float theta_v);
/// Anisotropy of a Glossy (or Anisotropic) BSDF whose tangent lies in the plane of incidence.
float anisotropy_input(float anisotropy);

}  // namespace velour
