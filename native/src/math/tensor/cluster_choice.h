// Choice of the clusters that represent a slice.
#pragma once

#include <span>

#include "math/tensor/clustered_tensor.h"

namespace velour {

/// Inner products of slices and bases; choices need nothing else, so slices are read only once. Immutable.
class ClusterProducts {
 public:
  /// `slices`: [slice][entry]; every basis [rank][entry] with orthonormal rows.
  ClusterProducts(const TensorView& slices, const std::vector<RowMatrix>& basis, const TensorOptions& options,
                  const Progress& progress);

  Index rank() const { return rank_; }
  Index clusters() const { return products_.cols() / rank_; }
  Index slices() const { return projection_.rows(); }

  /// Squared norm that a cluster keeps of a slice a: |a|^2 minus this is the squared error.
  double kept(Index slice, Index cluster) const;
  /// Least-squares fit of a slice by several clusters: sets their coefficients, cluster by cluster, and returns the
  /// squared norm that they keep.
  double solve(Index slice, std::span<const uint32_t> clusters, Eigen::Ref<Eigen::RowVectorXf> coefficient) const;
  /// Adds the cluster that explains most of the residual of `clusters` with `coefficient` (block orthogonal matching
  /// pursuit [TGS06]), in ascending order.
  void extend(Index slice, std::vector<uint32_t>& clusters, const Eigen::RowVectorXf& coefficient) const;

 private:
  Index rank_;
  RowMatrix projection_;  // [slice][cluster, rank]
  RowMatrix products_;    // [cluster, rank][cluster, rank]
};

/// Squared norm that members keep, summed over all slices.
struct KeptSquares {
  double before;  // with the previous members; 0 if there were none
  double after;
};

/// Chooses members and coefficients of every slice greedily, but keeps the members of `tensor` where they are better,
/// so the error never rises. The result does not depend on the number of threads.
KeptSquares choose_members(const ClusterProducts& products, ClusteredTensor& tensor, const TensorOptions& options,
                           const Progress& progress);

}  // namespace velour
