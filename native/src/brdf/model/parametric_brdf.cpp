#include "brdf/model/parametric_brdf.h"

#include <cmath>

namespace velour {
namespace {

LobeParameters parameters_at(const ParametricBrdf& brdf, const ViewTaps& taps, int lobe) {
  LobeParameters p{};
  for (int i = 0; i < taps.count; ++i) {
    for (int k = 0; k < brdf.parameter_count(); ++k) {
      const double weight = k == ParametricBrdf::kTiltX ? taps.odd_weight[i] : taps.weight[i];
      p[static_cast<size_t>(k)] += weight * static_cast<double>(brdf.control[brdf.index(taps.node[i], k, lobe)]);
    }
  }
  return p;
}

/// Rotates `lobe` from the view's frame, in which it is stored, to the surface's by the view's azimuth.
void turn(WarpedLobe& lobe, double c, double s) {
  const Vec3d at = lobe.center;
  lobe.center = {c * at.x - s * at.y, s * at.x + c * at.y, at.z};
  const Stretch k = lobe.stretch;
  lobe.stretch = {c * c * k.xx - 2 * c * s * k.xy + s * s * k.yy, c * s * (k.xx - k.yy) + (c * c - s * s) * k.xy,
                  s * s * k.xx + 2 * c * s * k.xy + c * c * k.yy};
}

WarpedLobe lobe_at(const ParametricBrdf& brdf, const Vec3d& wv, const ViewTaps& taps, int j) {
  const double fade = brdf.isotropic ? pole_fade(wv) : 1.0, sine = std::hypot(wv.x, wv.y);
  WarpedLobe lobe = lobe_of(parameters_at(brdf, taps, j), brdf.space[static_cast<size_t>(j)], fade);
  if (brdf.isotropic && sine > 0) turn(lobe, wv.x / sine, wv.y / sine);
  return lobe;
}

}  // namespace

WarpedLobe lobe_of(const LobeParameters& p, LobeSpace space, double fade) {
  using P = ParametricBrdf;
  return {space, stretch_from(fade * p[P::kStretchA], fade * p[P::kStretchB]),
          tilted_normal(p[P::kTiltX], p[P::kTiltY]), std::exp(p[P::kLogBandwidth]),
          Vec3d(std::exp(p[P::kLogRed]), std::exp(p[P::kLogGreen]), std::exp(p[P::kLogBlue]))};
}

void store_shape(const WarpedLobe& lobe, LobeParameters& p) {
  using P = ParametricBrdf;
  p[P::kLogBandwidth] = std::log(lobe.bandwidth);
  const glm::dvec2 tilt = tilt_of(lobe.center), stretch = exponents_of(lobe.stretch);
  p[P::kTiltX] = tilt.x;
  p[P::kTiltY] = tilt.y;
  p[P::kStretchA] = stretch.x;
  p[P::kStretchB] = stretch.y;
}

WarpedLobe lobe_at(const ParametricBrdf& brdf, const Vec3d& wv, int lobe) {
  return lobe_at(brdf, wv, brdf.spline().at(wv), lobe);
}

std::vector<WarpedLobe> lobes_at(const ParametricBrdf& brdf, const Vec3d& wv) {
  const ViewTaps taps = brdf.spline().at(wv);
  std::vector<WarpedLobe> lobes;
  for (int j = 0; j < brdf.lobe_count(); ++j) lobes.push_back(lobe_at(brdf, wv, taps, j));
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
