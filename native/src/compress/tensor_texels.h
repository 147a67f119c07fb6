// The texels of one level of a model of clustered tensors, for clusters that are given.
#pragma once

#include <functional>

#include "compress/seen_texels.h"
#include "compress/shown_views.h"
#include "compress/tensor_functions.h"

namespace velour {

/// Least squares over every pair and texel of a level. Members are chosen by what the views show of the points of the
/// relief, greedily ([TGS06] block orthogonal matching pursuit), and their coefficients with them. Over a relief all
/// texels are then solved for together, by conjugate gradients ([HS52]) on the images themselves: a value is the sum of
/// functions with coefficients interpolated where the view's ray meets the relief. Without one that is the same. What
/// views hide is fitted to what stands in for it (ShownViews), with little weight.
class TensorTexels {
 public:
  /// Keeps references.
  TensorTexels(const TensorSource& source, const SeenTexels& seen, const ShownViews& shown,
               const TensorFunctions& functions, const Progress& progress);

  /// Of every view once. `functions`: of all views.
  void add_view(Index view, const LevelImages& images, const std::vector<FunctionsOfView>& functions);

  /// After all views. `after_step` is told the part that is done.
  TensorTexelValues solve(Index members, const std::function<void(double)>& after_step) const;

  /// Of the images, as modelled_squares().
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
  RowMatrix shows_;   // texel x function: moments of what views show of its point
  RowMatrix hidden_;  // texel x function: of what stands in for it; empty where nothing is hidden
  RowMatrix data_;    // texel x function: moments of the images with what they are made of; empty on the plane
  double measured_ = 0;
};

/// The sum over texels, views and lights of the squares that `values` make, times both cosines.
double modelled_squares(const TensorSource& source, const SeenTexels& seen, const TensorFunctions& functions,
                        const TensorTexelValues& values, const Progress& progress);

}  // namespace velour
