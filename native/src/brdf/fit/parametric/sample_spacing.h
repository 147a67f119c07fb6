// Minimum width of a lobe that the samples of a view can resolve.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "brdf/fit/direction_tree.h"
#include "brdf/fit/parametric/warped_columns.h"
#include "math/srbf/warped_lobe.h"

namespace velour {

/// Limits lobes to what the samples of a view, one per cell of a DirectionTree, can resolve.
class SampleSpacing {
 public:
  /// `wv` is unit.
  SampleSpacing(std::shared_ptr<const DirectionTree> lights, const Vec3d& wv) : wv_(wv), lights_(std::move(lights)) {}

  /// Excess of the lobe's log bandwidth over what the samples can resolve; negative for lobes that are wide enough. A
  /// lobe must cover at least twice the solid angle of the cell at its brightest place. If its center is below the
  /// horizon, the tail above must also decay over at least half the spacing of the samples.
  double excess(const WarpedShape& shape) const { return excess(shape, log_solid_angle(shape)); }
  /// Derivatives of excess() by the first out.size() parameters of the shape, in the order of fill_warped_slopes,
  /// within that cell.
  void slopes(const WarpedShape& shape, Eigen::Ref<Eigen::VectorXd> out) const;

 private:
  struct Shown {
    Vec3d wl;
    double steep;  // decay of the tail (1 / rad) if the center is below the horizon, otherwise 0
  };

  Shown shown(const WarpedLobe& lobe) const;
  double log_solid_angle(const WarpedShape& shape) const;
  double excess(const WarpedShape& shape, double log_cell) const;
  double steepness(const WarpedLobe& lobe, const Vec3d& at) const;

  Vec3d wv_;
  std::shared_ptr<const DirectionTree> lights_;
};

}  // namespace velour
