// Gaussian SRBFs with their own parameterization: lobes over light directions whose argument is warped.
//
// [T09 ch. 4] fits the variable transformation of an SRBF, as a parametric model, together with the SRBF. Ours is
//   psi = normalize(S y),  y = wl (light space) or wl + wv (half space),  S = [[s_xx, s_xy], [s_xy, s_yy]] (+) 1,
// with det S = 1: S stretches the tangent plane, so that one lobe can represent an elongated highlight. The
// transformation, its inverse and Jacobian, the density and the samples have closed forms (docs/engine/equations.md).
// Scalar reference in double; eval_warped.cpp and sample_warped.cpp are tested against it.
#pragma once

#include <optional>

#include "math/sphere/vec.h"

namespace velour {

/// The argument of a lobe.
enum class LobeSpace {
  light = 0,  // wl
  half = 1,   // the half vector
};

/// Symmetric positive stretch of the tangent plane with determinant 1.
struct Stretch {
  double xx = 1, xy = 0, yy = 1;
};

/// exp [[-a, b], [b, a]]: stretches by e^m along one axis and e^-m along the other, m = |(a, b)|. With positive a the
/// lobe is longer in x (the argument is squeezed there).
Stretch stretch_from(double a, double b);
/// normalize(S y).
Vec3d stretched(const Stretch& stretch, const Vec3d& y);
/// Inverse of stretch_from; returns (a, b).
glm::dvec2 exponents_of(const Stretch& stretch);
/// Derivatives of stretch_from; they are not stretches themselves.
struct StretchSlopes {
  Stretch by_a, by_b;
};
StretchSlopes stretch_slopes(double a, double b);

/// Direction tilted (radians) from the normal: the exponential map of the sphere, smooth at 0.
Vec3d tilted_normal(double tilt_x, double tilt_y);
/// Inverse of tilted_normal; returns (tilt_x, tilt_y), of a length of at most pi.
glm::dvec2 tilt_of(const Vec3d& center);
struct TiltSlopes {
  Vec3d by_x, by_y;
};
TiltSlopes tilt_slopes(double tilt_x, double tilt_y);

/// coefficient exp(bandwidth (psi . center - 1)).
struct WarpedLobe {
  LobeSpace space = LobeSpace::light;
  Stretch stretch;
  Vec3d center{0, 0, 1};  // unit
  double bandwidth = 1;   // > 0
  Vec3d coefficient{0};   // of f, 1/sr, linear Rec. 709
};

/// Unit psi of `wl`. Half lobes require wl != -wv.
Vec3d warped(const WarpedLobe& lobe, const Vec3d& wl, const Vec3d& wv);
/// y / |y| of `psi`: the light direction or half vector that warps to psi.
Vec3d argument_at(const WarpedLobe& lobe, const Vec3d& psi);
/// Light direction of `psi`; none if psi corresponds to a half vector that faces away from wv.
std::optional<Vec3d> unwarped(const WarpedLobe& lobe, const Vec3d& psi, const Vec3d& wv);
/// Ratio of solid angles d psi / d wl: 1 / |S y|^3 in light space, |y|^2 / (2 |S y|^3) in half space.
double warp_jacobian(const WarpedLobe& lobe, const Vec3d& wl, const Vec3d& wv);
/// Value of the kernel; its peak is 1.
double warped_kernel(const WarpedLobe& lobe, const Vec3d& wl, const Vec3d& wv);

}  // namespace velour
