// Gaussian SRBFs with a parameterisation of their own: a lobe over light directions whose argument is warped.
//
// [T09 ch. 4] makes the variable transformation of an SRBF a model that is fitted with it. Ours is
//   psi = normalize(S y),  y = wl (light space) or wl + wv (half space),  S = [[s_xx, s_xy], [s_xy, s_yy]] (+) 1,
// with det S = 1: S stretches the tangent plane, so that one lobe follows a highlight that is longer than wide. Both
// directions of the transformation are closed forms, and so are its Jacobian, the density and the samples
// (docs/equations.md). Scalar reference in double; warped_mixture.cpp is tested against it.
#pragma once

#include <optional>

#include "sphere/vec.h"

namespace velour {

/// What the argument of a lobe is made of.
enum class LobeSpace {
  light = 0,  // wl
  half = 1,   // the half vector
};

/// Symmetric positive stretch of the tangent plane with determinant 1.
struct Stretch {
  double xx = 1, xy = 0, yy = 1;
};

/// exp [[-a, b], [b, a]]: by e^m along one axis and e^-m along the other, m = |(a, b)|. Positive a is longer in x of
/// the directions (the argument is squeezed there).
Stretch stretch_from(double a, double b);
/// Unit S y.
Vec3d stretched(const Stretch& stretch, const Vec3d& y);
/// The inverse of stretch_from: (a, b).
glm::dvec2 exponents_of(const Stretch& stretch);
/// Its derivatives; they are no stretches themselves.
struct StretchSlopes {
  Stretch by_a, by_b;
};
StretchSlopes stretch_slopes(double a, double b);

/// Centre of tilt `t` (radians) from the normal: the exponential map of the sphere, smooth at 0.
Vec3d tilted_normal(double tilt_x, double tilt_y);
/// The inverse, up to pi long: (tilt_x, tilt_y).
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

/// psi of `wl`, unit. For half lobes wl != -wv.
Vec3d warped(const WarpedLobe& lobe, const Vec3d& wl, const Vec3d& wv);
/// y / |y| of `psi`: the light direction or half vector where the lobe's argument is psi.
Vec3d argument_at(const WarpedLobe& lobe, const Vec3d& psi);
/// The light direction of `psi`; none where psi belongs to a half vector that faces away from wv.
std::optional<Vec3d> unwarped(const WarpedLobe& lobe, const Vec3d& psi, const Vec3d& wv);
/// d psi / d wl, ratio of solid angles: 1 / |S y|^3 in light space, |y|^2 / (2 |S y|^3) in half space.
double warp_jacobian(const WarpedLobe& lobe, const Vec3d& wl, const Vec3d& wv);
/// The kernel, peak 1.
double warped_kernel(const WarpedLobe& lobe, const Vec3d& wl, const Vec3d& wv);

}  // namespace velour
