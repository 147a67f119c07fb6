// How narrow a lobe may be before it hides between the samples of a view.
#pragma once

#include <array>
#include <Eigen/Core>
#include <span>

#include "fit/slice_samples.h"
#include "fit/warped_columns.h"
#include "srbf/warped_lobe.h"

namespace velour {

/// The solid angle that one sample of a view stands for, as it varies over the light directions: of the finest samples
/// about a direction, so that highlights, where samples crowd, may be sharp. Continuous.
class SampleSpacing {
 public:
  /// `samples` weigh their solid angle (sr); `wv` is unit.
  SampleSpacing(std::span<const SliceSample> samples, const Vec3d& wv);

  /// By how much the logarithm of the lobe's bandwidth is above what the samples can tell; negative for lobes that are
  /// wide enough. A lobe is to spread over the solid angle of a sample at its centre, and what rises above the horizon
  /// of one whose centre lies below it is to be at least half as high as the samples are apart. Without samples any
  /// bandwidth will do.
  double excess(const WarpedShape& shape) const;
  /// Its derivatives by the parameters of the shape, in the order of fill_warped_slopes: as many as `out` has.
  void slopes(const WarpedShape& shape, Eigen::Ref<Eigen::VectorXd> out) const;

 private:
  static constexpr int kSide = 16;
  using Cells = std::array<float, static_cast<size_t>(kSide* kSide)>;
  static glm::dvec2 place_of(const Vec3d& wl);
  void spread();
  double log_solid_angle(const Vec3d& wl) const;
  double steepness(const WarpedLobe& lobe, const Vec3d& at) const;

  Vec3d wv_;
  bool empty_;
  Cells log_cell_;  // logarithm of sr, over the equal-area disk of light directions
};

}  // namespace velour
