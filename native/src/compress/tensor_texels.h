// The texels of one level of a model of clustered tensors, for clusters that are given.
#pragma once

#include <functional>

#include "compress/tensor_functions.h"

namespace velour {

/// Clusters of each texel, distinct and ascending, and their coefficients.
struct TensorTexelValues {
  std::vector<uint32_t> member;  // [texel][k]
  RowMatrix value;               // [texel][k, rank]
};

/// Least squares over every pair and texel of a level. Members are chosen by what the views show of the points of the
/// relief, greedily ([TGS06] block orthogonal matching pursuit), and their coefficients with them. Over a relief all
/// texels are then solved for together, by conjugate gradients ([HS52]) on the images themselves: a value is the sum of
/// functions with coefficients interpolated where the view's ray meets the relief. Without one that is the same.
class TensorTexels {
 public:
  TensorTexels(const TensorSource& source, size_t level, const TensorFunctions& functions, const Progress& progress);

  /// Of every view once.
  void add_view(Index view, const LevelImages& images, const TensorFunctions::OfView& functions);

  /// After all views. `after_step` is told the part that is done.
  TensorTexelValues solve(Index members, const std::function<void(double)>& after_step) const;

  /// Sums of squares over texels, views and lights, times both cosines: of the images, and of what values make of them.
  double measured() const { return measured_; }
  double modelled(const TensorTexelValues& values) const;

 private:
  class OfTexel;
  struct Sources;
  size_t texels() const { return size_t{relief_.width()} * relief_.height(); }
  BilinearTexels seen(Index view, size_t texel) const;
  Sources sources(Index view) const;
  void choose(size_t texel, TensorTexelValues& values) const;
  RowMatrix spread(Index view, size_t first, size_t end, const TensorTexelValues& values) const;
  void add_products(Index view, const TensorTexelValues& values, RowMatrix& sums) const;
  RowMatrix normal_product(const TensorTexelValues& values) const;
  void refine(TensorTexelValues& values, const std::function<void(double)>& after_step) const;
  template <class Work>
  void pieces(const Work& work) const;

  const TensorSource& source_;
  const Relief& relief_;
  const TensorFunctions& functions_;
  const Progress& progress_;
  const bool plane_;
  std::vector<Vec2> seen_;      // [view][texel]: where its ray meets the relief, in texels; none on the plane
  std::vector<uint8_t> shown_;  // [texel][view]: whether the view shows the texel's point
  RowMatrix shows_;             // texel x function: moments of what views show of its point
  RowMatrix data_;  // texel x function: moments of the images with what they are made of; empty on the plane
  double measured_ = 0;
};

}  // namespace velour
