// Converts lobes over half vectors, or stretched lobes, to Gaussians over light directions.
#pragma once

#include <span>
#include <vector>

#include "math/srbf/warped_lobe.h"

namespace velour {

/// Part of f cos: color times a Gaussian whose integral over the sphere is 1. Colors may be negative.
struct LightGaussian {
  Vec3d center{0, 0, 1};
  double bandwidth = 1;
  Vec3d color{0.0};
  /// False if it represents nothing: its lobe has no light direction there, or none above the horizon, or is left to
  /// the broad part. It is then black, and its center arbitrary.
  bool is_used = false;
};

/// Extent of a lobe among light directions: the length there of one radian of its argument, along and across.
struct LobeReach {
  Vec3d along{0.0};  // unit direction of the argument that becomes longest among lights
  double longer = 1, shorter = 1;
  bool is_seen = false;  // the lobe's center has a light direction
};

/// A lobe with its bandwidth along its longest direction; the bandwidth across may differ.
struct ReachedLobe {
  WarpedLobe lobe;
  LobeReach reach;
  Vec3d peak{0.0};
  glm::dmat2 curvature{1.0};  // of the negative logarithm at the peak, in Frame::about(lobe.center)

  double bandwidth_across() const { return lobe.bandwidth / (reach.shorter * reach.shorter); }
  Vec3d value(const Vec3d& wl, const Vec3d& wv) const;
};
ReachedLobe reached(const WarpedLobe& lobe, const Vec3d& wv);
/// A lobe whose peak at its center is `lobe`'s coefficient; the argument's deviations around it form the ellipse to
/// which `deviations` maps the unit circle of Frame::about(lobe.center).
ReachedLobe reached(const WarpedLobe& lobe, const glm::dmat2& deviations, const Vec3d& wv);

/// Number of Gaussians (odd) that resolve a lobe `ratio` times as long as wide.
size_t gaussians_for(double ratio);
/// The function that lobes represent.
enum class LobeOf { f, f_cosine };
/// Fills `out` with the Gaussians of one lobe, seen from `wv`; black if it has nothing above the horizon.
void light_gaussians(const ReachedLobe& lobe, LobeOf of, const Vec3d& wv, std::span<LightGaussian> out);

/// The sum of `gaussians` at `wl`.
Vec3d value_of(std::span<const LightGaussian> gaussians, const Vec3d& wl);

}  // namespace velour
