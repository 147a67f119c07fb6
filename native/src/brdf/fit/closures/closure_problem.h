// Closures as a least-squares problem over the unknowns of ClosureCurves.
#pragma once

#include <algorithm>
#include <Eigen/Core>
#include <vector>
#include "brdf/fit/closures/closure_lights.h"
#include "brdf/fit/closures/closures.h"

namespace velour {

// Sums over the lights of a view that its residuals and their derivatives consist of.

/// Rows over the lights, times root_weight: the diffuse lobe, then of each lobe its value and, with slopes, its
/// derivatives by the unknowns alpha, tilt and anisotropy. Products of the rows with each other and with the target.
struct ViewProducts {
  static constexpr int kSlopeRows = 4, kMaxRows = 1 + kSlopeRows * kMaxClosureLobes;

  ViewProducts(const ClosureTarget& target_at_view, const std::vector<LobeDistribution>& distributions,
               LobeMasking masking, const ClosureBounds& bounds, const ViewUnknowns& u, bool slopes);

  double gram(int a, int b) const { return static_cast<double>(gram_[std::max(a, b) * rows + std::min(a, b)]); }
  /// Integral of a row over the hemisphere.
  double mass(int a) const { return static_cast<double>(target[a][3]); }

  int rows, rows_per_lobe;
  float target[kMaxRows][4];  // with each channel of the target, and with its integral

 private:
  float gram_[kMaxRows * kMaxRows];
};

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
