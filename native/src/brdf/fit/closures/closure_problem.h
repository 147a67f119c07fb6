// Closures as a least-squares problem over the unknowns of closure_curves.h.
#pragma once

#include <Eigen/Core>
#include <vector>
#include "brdf/fit/closures/closure_curves.h"
#include "brdf/fit/closures/closure_lights.h"

namespace velour {

/// The BRDF at a view of the fit, and the inverse norms that make residuals relative. Nearly black views and channels
/// count less: norms have lower bounds relative to the largest of all views, and to the view's luminance.
struct ClosureView {
  ClosureTarget target;
  double inverse_norm_sq[3] = {}, inverse_norm_sq_luminance = 0, inverse_albedo_sq[3] = {};
  Eigen::Matrix<double, kClosureKnots, 1> taps;
};

/// Views of a fit. Empty if the source is black.
std::vector<ClosureView> closure_views(std::vector<ClosureTarget> targets);

/// Minimizes the sum over views of squared residuals, relative to the view's own norms: f cos of each channel, its
/// luminance, and the albedo of each channel; and of a small penalty on bent curves of shapes. Unknowns in the order of
/// ClosureUnknowns, column by column.
class ClosureProblem {
 public:
  struct Normal {
    Eigen::MatrixXd curvature;  // lower triangle
    Eigen::VectorXd slope;
    Eigen::VectorXd step(double damping) const;
  };

  /// `views` must outlive the problem.
  ClosureProblem(const std::vector<ClosureView>& views, std::vector<LobeDistribution> distributions,
                 LobeMasking masking, const ClosureBounds& bounds);

  double cost(const ClosureUnknowns& u) const;
  /// Sums run in a fixed order.
  Normal normal(const ClosureUnknowns& u) const;
  ClosureUnknowns moved(const ClosureUnknowns& u, const Eigen::VectorXd& step) const;

 private:
  struct ViewNormal;
  void add_to(Normal& n, const ClosureView& view, const ViewNormal& of_view) const;

  const std::vector<ClosureView>& views_;
  std::vector<LobeDistribution> distributions_;
  LobeMasking masking_;
  ClosureBounds bounds_;
};

}  // namespace velour
