// Minimum width of a lobe that the samples of a view can resolve.
#pragma once

#include <array>
#include <Eigen/Core>
#include <span>

#include "brdf/fit/parametric/warped_columns.h"
#include "brdf/fit/slice_samples.h"
#include "math/srbf/warped_lobe.h"

namespace velour {

/// Solid angle of one sample of a view as a continuous function of the light direction: that of the finest samples
/// nearby, so that highlights, where samples are dense, may be sharp.
class SampleSpacing {
 public:
  /// Weights of `samples` are solid angles (sr); `wv` is unit.
  SampleSpacing(std::span<const SliceSample> samples, const Vec3d& wv);

  /// Excess of the lobe's log bandwidth over what the samples can resolve; negative for lobes that are wide enough. A
  /// lobe must cover at least the solid angle of a sample at its center. If the center is below the horizon, the tail
  /// above it must also decay over at least half the spacing of the samples. Without samples, any bandwidth is allowed.
  double excess(const WarpedShape& shape) const;
  /// Derivatives of excess() by the first out.size() parameters of the shape, in the order of fill_warped_slopes.
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
  Cells log_cell_;  // log of the solid angle (sr), over the equal-area disk of light directions
};

}  // namespace velour
