// Fits one slice: adds one lobe at a time, and solves for all of them together.
#pragma once

#include <vector>
#include "base/progress.h"
#include "brdf/fit/slice_columns.h"

namespace velour {

// Fits one slice with J lobes: centers, bandwidths and non-negative RGB coefficients together
// (docs/engine/brdf_fitting.md).

/// A lobe in the solver: `peak` (RGB, >= 0) times the unit-peak shape.
struct SliceLobe {
  LobeShape shape;
  Vec3d peak{0, 0, 0};
};

/// The model of a slice: F_c(wl) = diffuse_c max(wl.z, 0) + sum_j peak_jc S_j(wl). E = sum_c w_c sum_i q_i (F_ic -
/// model_ic)^2 with w_c the luminance weights. Because they sum to 1, E is never below the squared error of the
/// luminance (Jensen), which the tolerance bounds.
///
/// The peaks are always the non-negative least-squares solution for the current shapes (variable projection); the
/// shapes move by Levenberg-Marquardt steps. J^T J of an RGB fit factorizes,
///   (d lobe_j / d a) . (d lobe_k / d b) summed over channels = (sum_c w_c peak_jc peak_kc) (D_ja . D_kb),
/// so one Gram matrix of the J values and 3 J derivatives serves all channels.
class SliceSolver {
 public:
  SliceSolver(Kernel kernel, const SliceSamples& samples, const Progress& progress);

  /// Replaces the lobes and solves for their peaks.
  void set_lobes(std::vector<LobeShape> shapes);
  void add_lobe(const LobeShape& shape);

  /// Tries at most `steps` Levenberg-Marquardt steps, accepted or rejected. Ends early if the luminance error is at
  /// most `goal` (relative L2) or if an accepted step gains less than `least_gain` of E. E never rises.
  void refine(int steps, double goal, double least_gain);

  double objective() const { return state_.objective; }
  /// Relative L2 of the luminance over the samples; 0 for a black slice that is fitted as black.
  double relative_l2() const;
  int count() const { return static_cast<int>(state_.shapes.size()); }
  const std::vector<LobeShape>& shapes() const { return state_.shapes; }
  std::vector<SliceLobe> lobes() const;
  /// Coefficient of the cosine term, the diffuse part (RGB, >= 0, 1/sr).
  Vec3d diffuse() const;
  const float* residual(int c) const { return state_.residual[static_cast<size_t>(c)]; }

  /// Maximum sharpness at `center`: the half-width of a lobe is never below half the spacing of the samples there, so
  /// that no lobe hides between samples. If there are none nearby, the visible tail of the lobe bounds its peak.
  double max_sharpness(const Vec3d& center) const;

 private:
  /// The shapes and everything computed from them.
  struct State {
    explicit State(size_t padded) : values(padded), residual(padded) { residual.resize(3); }
    std::vector<LobeShape> shapes;
    Eigen::MatrixXd peaks;  // J + 1 rows of 3: the lobes, then the cosine term
    ColumnSet values, residual;
    Eigen::Matrix3d residual_products;  // dot products of the channels' residuals
    double objective = 0;
  };
  /// The normal equations of the shapes with the peaks eliminated; rows 3 j + {x, y, log sharpness}.
  struct Step {
    Eigen::MatrixXd normal;
    Eigen::VectorXd slope, scale;
  };

  std::vector<const float*> columns(const State& state) const;
  void solve(State& state) const;
  Step linearize();
  void eliminate_peaks(const Eigen::MatrixXd& products, int channel, Step& step) const;
  std::vector<LobeShape> moved(const Eigen::VectorXd& by) const;

  Kernel kernel_;
  const SliceSamples& samples_;
  const Progress& progress_;
  State state_, trial_;
  ColumnSet derivatives_;
  AlignedFloats cosine_;  // column of the cosine term
};

// Greedy fit of one slice: adds one lobe at a time until the goal or the bound is reached.

struct SliceFitOptions {
  Kernel kernel = Kernel::gaussian;
  int max_lobes = 16;
  double goal = 0.02;  // relative L2 of the luminance at which no more lobes are added
};

/// The lobes and the cosine term of a slice, and their luminance error over the fitted samples.
struct SliceFit {
  std::vector<SliceLobe> lobes;
  Vec3d diffuse{0, 0, 0};
  double relative_l2 = 1;
};

/// The path of the greedy fit: entry J is the best fit found with at most J lobes (entry 0 has none), and the errors
/// never rise along it. The last entry is the fit.
std::vector<SliceFit> fit_slice(const SliceSamples& samples, const SliceFitOptions& options, const Progress& progress);

// Converts the solver's lobes to those of a model.

/// A lobe as PerViewBrdf stores it: coefficient times kernel_value(kernel, bandwidth, d).
struct StoredLobe {
  Vec3 center;
  float bandwidth;
  Rgb coefficient;
};

/// Converts a lobe of the solver; the coefficient is for the bandwidth rounded to float.
StoredLobe stored_lobe(Kernel kernel, const SliceLobe& lobe);

}  // namespace velour
