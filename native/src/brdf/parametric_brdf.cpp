#include "brdf/parametric_brdf.h"

#include <array>
#include <cmath>

namespace velour {
namespace {

using Parameters = std::array<double, ParametricBrdf::kAnisotropicCount>;

Parameters parameters_at(const ParametricBrdf& brdf, const ViewTaps& taps, int lobe) {
  Parameters p{};
  for (int i = 0; i < taps.count; ++i) {
    for (int k = 0; k < brdf.parameter_count(); ++k) {
      const double weight = k == ParametricBrdf::kTiltX ? taps.odd_weight[i] : taps.weight[i];
      p[static_cast<size_t>(k)] += weight * static_cast<double>(brdf.control[brdf.index(taps.node[i], k, lobe)]);
    }
  }
  return p;
}

/// Turns `lobe` from the view's frame, in which it was stored, to the surface's by the view's azimuth.
void turn(WarpedLobe& lobe, double c, double s) {
  const Vec3d at = lobe.center;
  lobe.center = {c * at.x - s * at.y, s * at.x + c * at.y, at.z};
  const Stretch k = lobe.stretch;
  lobe.stretch = {c * c * k.xx - 2 * c * s * k.xy + s * s * k.yy, c * s * (k.xx - k.yy) + (c * c - s * s) * k.xy,
                  s * s * k.xx + 2 * c * s * k.xy + c * c * k.yy};
}

}  // namespace

std::vector<WarpedLobe> lobes_at(const ParametricBrdf& brdf, const Vec3d& wv) {
  const ViewTaps taps = brdf.spline().at(wv);
  const double fade = brdf.isotropic ? pole_fade(wv) : 1.0;
  const double sine = std::hypot(wv.x, wv.y);
  std::vector<WarpedLobe> lobes;
  for (int j = 0; j < brdf.lobe_count(); ++j) {
    const Parameters p = parameters_at(brdf, taps, j);
    WarpedLobe lobe;
    lobe.space = brdf.space[static_cast<size_t>(j)];
    lobe.center = tilted_normal(p[ParametricBrdf::kTiltX], p[ParametricBrdf::kTiltY]);
    lobe.stretch = stretch_from(fade * p[ParametricBrdf::kStretchA], fade * p[ParametricBrdf::kStretchB]);
    lobe.bandwidth = std::exp(p[ParametricBrdf::kLogBandwidth]);
    lobe.coefficient = {std::exp(p[ParametricBrdf::kLogRed]), std::exp(p[ParametricBrdf::kLogGreen]),
                        std::exp(p[ParametricBrdf::kLogBlue])};
    if (brdf.isotropic && sine > 0) turn(lobe, wv.x / sine, wv.y / sine);
    lobes.push_back(lobe);
  }
  return lobes;
}

Vec3d value_of(const std::vector<WarpedLobe>& lobes, const Vec3d& wl, const Vec3d& wv) {
  Vec3d f(0);
  for (const WarpedLobe& lobe : lobes) f += lobe.coefficient * warped_kernel(lobe, wl, wv);
  return f;
}

Vec3d value_of(const ParametricBrdf& brdf, const Vec3d& wl, const Vec3d& wv) {
  const Vec3d f = value_of(lobes_at(brdf, wv), wl, wv);
  return brdf.symmetric ? 0.5 * (f + value_of(lobes_at(brdf, wl), wv, wl)) : f;
}

}  // namespace velour
