// A BRDF as nodes of Blender: a Diffuse BSDF and up to three Glossy BSDFs whose colors and shapes are curves over the
// view angle; and the unknowns of its fit.
#pragma once

#include <array>
#include <cstddef>
#include <Eigen/Core>
#include <vector>
#include "base/memory.h"
#include "brdf/fit/closures/closure_lights.h"
#include "math/sphere/vec.h"

namespace velour {

// A Glossy BSDF of Cycles with a tilted normal, and its derivatives, at all lights of a view. Formulas are those of
// kernel/closure/bsdf_microfacet.h and bsdf_ashikhmin_shirley.h.

enum class LobeDistribution {
  ggx,
  beckmann,
  ashikhmin_shirley,  // [AS00] without a Fresnel term; not tilted, and its masking is its own
};

/// Where x lies that lobes stretch along.
enum class ClosureFrame {
  incidence,  // in the plane of incidence: isotropic materials
  surface,    // along the tangent: anisotropic materials, whose lobes are not tilted
};

/// Masking and shadowing of microfacets by Smith's function.
enum class LobeMasking {
  separable,          // G1(wv) G1(wl): Blender before 3.5
  height_correlated,  // 1 / (1 + Lambda(wv) + Lambda(wl)): later versions
};

/// A lobe at a view.
struct ClosureLobeShape {
  LobeDistribution distribution = LobeDistribution::ggx;
  LobeMasking masking = LobeMasking::separable;
  float alpha_x = 1, alpha_y = 1;
  float tilt = 0;  // radians; N' = (sin(tilt), 0, cos(tilt)); the viewer is in front of N'
};

// Arrays of floats are aligned to cache lines (AlignedArray).

/// D G / (4 wv.N') (1/sr, f cos where the lobe is not tilted) times root_weight, for each light; 0 behind N'.
void fill_lobe(const ClosureLights& lights, const ClosureLobeShape& shape, float* value);

/// Factors of the derivatives by log(alpha_x), log(alpha_y) and the tilt in those by three other parameters.
struct LobeChain {
  float alpha_x, alpha_y;      // parameter 0
  float tilt;                  // parameter 1
  float stretch_x, stretch_y;  // parameter 2
};

/// fill_lobe(), and its derivatives by the three parameters of `chain`. Rows of `out` are padded() apart.
void fill_lobe_slopes(const ClosureLights& lights, const ClosureLobeShape& shape, const LobeChain& chain, float* out);

/// Dot products of `rows` rows of `count` floats each, a multiple of 16: `gram` gets those of each pair (row-major,
/// only j <= i is set), `moments` those with each of the four arrays of `fixed`.
void fill_products(const float* data, int rows, size_t count, const float* const fixed[4], float* gram,
                   float (*moments)[4]);

/// Samples of a curve at theta_v = 90 degrees * i / (kClosureSamples - 1), linear between them.
inline constexpr int kClosureSamples = 65;
template <class T>
using ClosureCurve = std::array<T, kClosureSamples>;

/// One Glossy BSDF. Its normal N' is turned by tilt * theta_v in the plane of incidence: 1 points it at the viewer,
/// negative values away from it. Its alpha is roughness^2 e^anisotropy along x (ClosureFrame), and
/// roughness^2 e^-anisotropy along y; both are at most 1.
struct ClosureLobe {
  LobeDistribution distribution = LobeDistribution::ggx;
  ClosureCurve<Rgb> weight{};       // not negative; may exceed 1
  ClosureCurve<float> roughness{};  // square root of alpha, in (0, 1]
  ClosureCurve<float> tilt{};       // in [-1, 1]
  ClosureCurve<float> anisotropy{};
};

struct ClosureNetwork {
  ClosureFrame frame = ClosureFrame::incidence;
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
/// Anisotropy of a Glossy (or Anisotropic) BSDF whose tangent is x.
float anisotropy_input(float anisotropy);

// Unknowns of a fit of closures: values at knots in theta_v of a cubic spline, mapped smoothly to bounded parameters.

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
  ClosureFrame frame = ClosureFrame::incidence;
  bool stretched_beckmann = true;  // false: lobes of Beckmann are round
};

/// The distributions of lobes: GGX, and one without long tails that may be stretched where the material needs it.
std::array<LobeDistribution, 2> closure_distributions(const ClosureBounds& bounds);

/// Parameters of a lobe at a view and their derivatives by the unknowns. alpha e^|anisotropy| stays below 1.
struct ClosureShape {
  double alpha, tilt, anisotropy;           // tilt: relative to theta_v
  double log_alpha_by_alpha, tilt_by_tilt;  // derivatives by the unknown named last
  double anisotropy_by_alpha, anisotropy_by_anisotropy;
};
ClosureShape closure_shape(double alpha_unknown, double tilt_unknown, double anisotropy_unknown, double theta_v,
                           const ClosureBounds& bounds, LobeDistribution distribution = LobeDistribution::ggx);
/// The unknown that closure_shape() maps to `alpha`, moved inside the bounds.
double closure_alpha_unknown(double alpha, const ClosureBounds& bounds);
/// The unknown that closure_shape() maps to `anisotropy` at an unknown of alpha, far from the normal; moved inside.
double closure_anisotropy_unknown(double anisotropy, double alpha_unknown, const ClosureBounds& bounds);
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
