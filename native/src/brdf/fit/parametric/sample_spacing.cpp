#include "brdf/fit/parametric/sample_spacing.h"

#include <algorithm>
#include <cmath>

namespace velour {
namespace {

constexpr double kMaxRise = 0.5;  // of the brightest place of a tail above the horizon
constexpr double kMinCenterCosine = 1e-3;
// A lobe on the border of two cells may be far from both samples, and one sample in eight is held out.
constexpr double kCells = 2;

/// Light direction at the center of the lobe. Half vectors that face away from the view have none, so their cosine with
/// it is clamped.
Vec3d light_at_center(const WarpedLobe& lobe, const Vec3d& wv) {
  const Vec3d center = argument_at(lobe, lobe.center);
  if (lobe.space == LobeSpace::light) return center;
  return 2 * std::max(glm::dot(center, wv), kMinCenterCosine) * center - wv;
}

WarpedLobe lobe_of(const WarpedShape& s) {
  return {s.space, stretch_from(s.stretch_a, s.stretch_b), tilted_normal(s.tilt_x, s.tilt_y),
          std::exp(s.log_bandwidth)};
}

Vec3d horizon_under(const Vec3d& wl) {
  const double length = std::hypot(wl.x, wl.y);
  return length > 0 ? Vec3d(wl.x / length, wl.y / length, 0) : Vec3d(1, 0, 0);
}

}  // namespace

/// Decrease of the logarithm of the lobe from the horizon upwards, per radian.
double SampleSpacing::steepness(const WarpedLobe& lobe, const Vec3d& at) const {
  constexpr double kStep = 1e-4;
  const Vec3d above = glm::normalize(at + Vec3d(0, 0, kStep));
  return lobe.bandwidth * glm::dot(warped(lobe, at, wv_) - warped(lobe, above, wv_), lobe.center) / kStep;
}

/// About where f cos of the lobe is largest: at its center or, if that is below the horizon, where the tail above it
/// has fallen to 1 / e.
SampleSpacing::Shown SampleSpacing::shown(const WarpedLobe& lobe) const {
  const Vec3d center = light_at_center(lobe, wv_);
  if (center.z >= 0) return {center, 0};
  const Vec3d horizon = horizon_under(center);
  const double steep = steepness(lobe, horizon);
  return {glm::normalize(horizon + Vec3d(0, 0, steep * kMaxRise > 1 ? 1 / steep : kMaxRise)), steep};
}

double SampleSpacing::log_solid_angle(const WarpedShape& shape) const {
  return std::log(lights_->leaf_at(Vec3(shown(lobe_of(shape)).wl)).solid_angle());
}

double SampleSpacing::excess(const WarpedShape& shape, double log_cell) const {
  const WarpedLobe lobe = lobe_of(shape);
  const Shown at = shown(lobe);
  const double narrow = std::log(kCells * lobe.bandwidth * warp_jacobian(lobe, at.wl, wv_) / (2 * kPiD)) + log_cell;
  return at.steep > 0 ? std::max(narrow, std::log(0.5 * at.steep) + 0.5 * log_cell) : narrow;
}

void SampleSpacing::slopes(const WarpedShape& shape, Eigen::Ref<Eigen::VectorXd> out) const {
  constexpr double WarpedShape::*kParameter[kWarpedSlopes] = {&WarpedShape::log_bandwidth, &WarpedShape::tilt_x,
                                                              &WarpedShape::stretch_a, &WarpedShape::tilt_y,
                                                              &WarpedShape::stretch_b};
  constexpr double kStep = 1e-5;
  const double log_cell = log_solid_angle(shape);
  for (Eigen::Index a = 0; a < out.size(); ++a) {
    WarpedShape more = shape, less = shape;
    more.*kParameter[a] += kStep;
    less.*kParameter[a] -= kStep;
    out[a] = (excess(more, log_cell) - excess(less, log_cell)) / (2 * kStep);
  }
}

}  // namespace velour
