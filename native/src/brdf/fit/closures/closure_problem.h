// Closures as a least-squares problem over the unknowns of closure_curves.h.
#pragma once

#include <array>
#include <Eigen/Core>
#include <vector>
#include "base/progress.h"
#include "brdf/fit/closures/closure_curves.h"
#include "brdf/fit/closures/closure_samples.h"
#include "math/optimize/levenberg_marquardt.h"

namespace velour {

/// Which unknowns of the lobes may differ from 0.
struct ClosureFreedoms {
  bool tilt = true, anisotropy = true;
  bool pin_anisotropy = true;  // 0 at theta_v = 0
};

/// Minimizes the sum over views of squared residuals, relative to the view's own norms: f cos of each channel, its
/// luminance, and the albedo of each channel. Unknowns in the order of ClosureUnknowns, column by column.
class ClosureProblem {
 public:
  using Normal = NormalEquations<Eigen::Dynamic>;

  /// `views` must outlive the problem.
  ClosureProblem(const std::vector<ClosureViewSamples>& views, std::vector<LobeDistribution> distributions,
                 LobeMasking masking, const ClosureBounds& bounds, const ClosureFreedoms& freedoms);

  const std::vector<LobeDistribution>& distributions() const { return distributions_; }
  double cost(const ClosureUnknowns& u) const;
  /// Sums run in a fixed order.
  Normal normal(const ClosureUnknowns& u) const;
  ClosureUnknowns moved(const ClosureUnknowns& u, const Eigen::VectorXd& step) const;

 private:
  /// Curvature and slope by the unknowns of one view.
  struct ViewNormal {
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxClosureUnknowns, kMaxClosureUnknowns>
        curvature;
    ViewUnknowns slope;
  };
  double view_cost(size_t view, const ViewUnknowns& u) const;
  ViewNormal view_normal(size_t view, const ViewUnknowns& u) const;
  ViewUnknowns at_view(const ClosureUnknowns& u, size_t view) const { return u.transpose() * taps_[view]; }
  void freeze(Normal& n) const;

  const std::vector<ClosureViewSamples>& views_;
  std::vector<Eigen::Matrix<double, kClosureKnots, 1>> taps_;  // of the views
  std::vector<LobeDistribution> distributions_;
  LobeMasking masking_;
  ClosureBounds bounds_;
  ClosureFreedoms freedoms_;
};

}  // namespace velour
