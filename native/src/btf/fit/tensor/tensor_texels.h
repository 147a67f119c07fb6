// Solver for the texels of a clustered-tensor model with given clusters, of one level and of all.
#pragma once

#include <functional>
#include "btf/fit/fit_checkpoint.h"
#include "btf/fit/seen_texels.h"
#include "btf/fit/tensor/direction_bases.h"
#include "btf/fit/tensor/tensor_functions.h"
#include "btf/model/tensor_btf.h"

namespace velour {

/// Least squares over every pair and texel of a level. Members and their coefficients are first chosen greedily
/// ([TGS06] block orthogonal matching pursuit) from the values of the relief points in the views. Over a relief, all
/// texels are then solved for together by conjugate gradients ([HS52]) on the images themselves: a value is the sum of
/// functions with coefficients interpolated where the view ray hits the relief. Without a relief both are the same.
/// Hidden points are fitted to their stand-ins (ShownViews) with little weight.
class TensorTexels {
 public:
  /// Keeps references to all arguments.
  TensorTexels(const TensorSource& source, const SeenTexels& seen, const ShownViews& shown,
               const TensorFunctions& functions, const Progress& progress);

  /// Call once per view. `functions`: of all views.
  void add_view(Index view, const LevelImages& images, const std::vector<FunctionsOfView>& functions);

  /// Call after all views. `after_step` receives the fraction done.
  TensorTexelValues solve(Index members, const std::function<void(double)>& after_step) const;

  /// modelled_squares() of the images themselves.
  double measured() const { return measured_; }

 private:
  class OfTexel;
  size_t texels() const { return seen_.texels(); }
  void add_hidden(Index view, const LevelImages& images, const std::vector<FunctionsOfView>& functions);
  void choose(size_t texel, TensorTexelValues& values) const;
  void add_products(Index view, const TensorTexelValues& values, RowMatrix& sums) const;
  RowMatrix normal_product(const TensorTexelValues& values) const;
  void refine(TensorTexelValues& values, const std::function<void(double)>& after_step) const;
  template <class Work>
  void pieces(const Work& work) const;

  const TensorSource& source_;
  const SeenTexels& seen_;
  const ShownViews& shown_;
  const TensorFunctions& functions_;
  const Progress& progress_;
  RowMatrix shows_;   // texel x function: moments of its point's values in the views
  RowMatrix hidden_;  // texel x function: moments of its stand-ins; empty if nothing is hidden
  RowMatrix data_;    // texel x function: moments of the images with the functions; empty on the plane
  double measured_ = 0;
};

/// The sum over texels, views and lights of the squares of the modeled values, times both cosines.
double modelled_squares(const TensorSource& source, const SeenTexels& seen, const TensorFunctions& functions,
                        const TensorTexelValues& values, const Progress& progress);

// Solves for the texels of a side of clustered tensors on all levels.

/// Sets the levels and scales of `side`, whose clusters are set, and refits its clusters: each level is solved for on
/// its own, scaled to the brightness of its images and rounded. Reads every view up to four times; steps in the
/// checkpoint under `stage` are reused. Progress covers the stage.
void solve_tensor_levels(CompandedViews& views, const TensorSource& source, Companding companding,
                         FitCheckpoint& checkpoint, const std::string& stage, Progress& progress, TensorSide& side);

// Rounding of the coefficients of clustered tensors to bytes.

/// Sets the scales of the clusters and the members and bytes of the levels of `side`, whose clusters and level sizes
/// are set. A scale spans the values of all levels; the effect of rounding a coefficient on a texel is compensated by
/// the coefficients after it (rounding_moves).
void set_rounded(const TensorFunctions& functions, std::vector<TensorTexelValues> levels, int threads,
                 const Progress& progress, TensorSide& side);

}  // namespace velour
