// A BRDF as nodes of Blender: a Diffuse BSDF and up to three Glossy BSDFs whose colors and shapes are curves over the
// view angle. Formulas are those of Cycles' closures (kernel/closure/bsdf_microfacet.h).
#pragma once

#include <array>
#include <vector>
#include "brdf/fit/closures/lobe_formula.h"
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

/// A network at one view: curves are looked up once for all light directions.
class ClosuresAtView {
 public:
  /// theta_v in radians, [0, pi / 2).
  ClosuresAtView(const ClosureNetwork& network, LobeMasking masking, float theta_v);

  /// f cos(theta_l) in 1/sr; `wl` in a frame whose +x-z plane holds the viewer on the side of +x. 0 below the horizon.
  Rgb f_cos(const Vec3& wl) const;
  /// Integral of f cos over the hemisphere by quadrature over half vectors of the lobes; error about 1e-3.
  Rgb albedo() const;

 private:
  float lobe_albedo(size_t k) const;

  Vec3 wv_;
  Rgb diffuse_;
  LobeMasking masking_;
  struct Lobe {
    LobeAtView shape;
    LobeDistribution distribution;
    Rgb weight;
  };
  std::vector<Lobe> lobes_;
};

/// f cos(theta_l) in 1/sr of any pair in the local frame; 0 unless both directions are above the horizon.
Rgb closure_f_cos(const ClosureNetwork& network, LobeMasking masking, const Vec3& wv, const Vec3& wl);

/// Directional albedo of channel `channel` (0 red, 1 green, 2 blue) at `theta_v` in radians, [0, pi / 2).
float closure_albedo(const ClosureNetwork& network, LobeMasking masking, float theta_v, int channel);

}  // namespace velour
