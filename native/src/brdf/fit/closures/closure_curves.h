// Unknowns of a fit of closures: values at knots in theta_v of a cubic spline, mapped smoothly to bounded parameters.
#pragma once

#include <array>
#include <Eigen/Core>
#include <vector>
#include "brdf/fit/closures/closures.h"

namespace velour {

inline constexpr int kClosureKnots = 10;
/// Maximum number of unknowns per view: three roots of diffuse albedos, and of each lobe three roots of weights, alpha,
/// tilt and anisotropy.
inline constexpr int kMaxClosureLobes = 3, kMaxClosureUnknowns = 3 + 6 * kMaxClosureLobes;

/// Polar angles of the knots (radians), from 0 to 89 degrees, denser at the limb.
std::array<double, kClosureKnots> closure_knots();

/// Factors of the values at the knots in the spline at `theta_v` (radians, held beyond the last knot). The spline has
/// slope 0 at the first knot and no curvature at the last.
Eigen::Matrix<double, kClosureKnots, 1> closure_taps(double theta_v);

/// Range of the parameters of lobes; that of tilts is given by lowest_closure_tilt().
struct ClosureBounds {
  double min_alpha = 0.02;
};

/// Parameters of a lobe at a view and their derivatives by the unknowns. alpha e^|anisotropy| stays below 1.
struct ClosureShape {
  double alpha, tilt, anisotropy;           // tilt: relative to theta_v
  double log_alpha_by_alpha, tilt_by_tilt;  // derivatives by the unknown named last
  double anisotropy_by_alpha, anisotropy_by_anisotropy;
};
ClosureShape closure_shape(double alpha_unknown, double tilt_unknown, double anisotropy_unknown, double theta_v,
                           const ClosureBounds& bounds);
/// The unknown that closure_shape() maps to `alpha`, moved inside the bounds.
double closure_alpha_unknown(double alpha, const ClosureBounds& bounds);
/// The unknown that closure_shape() maps to the relative tilt `tilt` at `theta_v`, in (-1, 1) and moved inside.
double closure_tilt_unknown(double tilt, double theta_v);

/// The unknowns of a network: a column per unknown of a view, a row per knot. Trivial to copy; no heap memory.
using ClosureUnknowns =
    Eigen::Matrix<double, kClosureKnots, Eigen::Dynamic, Eigen::ColMajor, kClosureKnots, kMaxClosureUnknowns>;
/// The unknowns at one view.
using ViewUnknowns = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxClosureUnknowns, 1>;

/// First of the six unknowns of lobe `k`: roots of the three weights, then alpha, tilt and anisotropy.
constexpr int lobe_unknown(int k) { return 3 + 6 * k; }

/// The network of the unknowns, sampled at the angles of ClosureCurve.
ClosureNetwork closure_network(const ClosureUnknowns& unknowns, const std::vector<LobeDistribution>& distributions,
                               const ClosureBounds& bounds);

}  // namespace velour
