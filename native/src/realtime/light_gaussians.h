// Lobes of half vectors, or stretched ones, as Gaussians of light directions.
#pragma once

#include <span>
#include <vector>

#include "srbf/warped_lobe.h"

namespace velour {

/// Of f cos: colour times a Gaussian whose integral over the sphere is 1. Colours may be negative.
struct LightGaussian {
  Vec3d center{0, 0, 1};
  double bandwidth = 1;
  Vec3d color{0.0};
  /// Else it stands for nothing: its lobe has no light there, or none above the horizon, or is left to the broad part.
  /// It is black then, and lies anywhere.
  bool is_used = false;
};

/// How a lobe lies over light directions about its own: what one radian of its argument is there, along and across.
struct LobeReach {
  Vec3d along{0.0};  // unit, of the argument: what becomes longest among lights
  double longer = 1, shorter = 1;
  bool is_seen = false;  // the lobe's centre has a light direction
};

/// A lobe of the bandwidth that it has along; across it may be another one.
struct ReachedLobe {
  WarpedLobe lobe;
  LobeReach reach;
  Vec3d peak{0.0};
  glm::dmat2 curvature{1.0};  // of minus the logarithm at the peak, in Frame::about(lobe.center)

  double bandwidth_across() const { return lobe.bandwidth / (reach.shorter * reach.shorter); }
  Vec3d value(const Vec3d& wl, const Vec3d& wv) const;
};
ReachedLobe reached(const WarpedLobe& lobe, const Vec3d& wv);
/// Of a peak of `lobe`'s coefficient at its centre, about which the argument's deviations are the ellipse that
/// `deviations` makes of the unit circle of Frame::about(lobe.center).
ReachedLobe reached(const WarpedLobe& lobe, const glm::dmat2& deviations, const Vec3d& wv);

/// Odd: as many Gaussians as resolve a lobe that is `ratio` times as long as wide.
size_t gaussians_for(double ratio);
/// What lobes are of.
enum class LobeOf { f, f_cosine };
/// Makes all of `out` of one lobe, seen from `wv`; black where it has nothing above the horizon.
void light_gaussians(const ReachedLobe& lobe, LobeOf of, const Vec3d& wv, std::span<LightGaussian> out);

/// The sum of `gaussians` at `wl`.
Vec3d value_of(std::span<const LightGaussian> gaussians, const Vec3d& wl);

}  // namespace velour
