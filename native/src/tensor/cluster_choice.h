// Which clusters a slice is made of.
#pragma once

#include <span>

#include "tensor/clustered_tensor.h"

namespace velour {

/// Slices and bases as far as choices need them: products alone, so no slice is touched again. Immutable.
class ClusterProducts {
 public:
  /// `slices`: [slice][entry]; every basis [rank][entry] with orthonormal rows.
  ClusterProducts(const TensorView& slices, const std::vector<RowMatrix>& basis, const TensorOptions& options,
                  const Progress& progress);

  Index rank() const { return rank_; }
  Index clusters() const { return products_.cols() / rank_; }
  Index slices() const { return projection_.rows(); }

  /// How much of the square of a slice a cluster keeps: |a|^2 less this is the error.
  double kept(Index slice, Index cluster) const;
  /// Least squares of a slice by some clusters together: their coefficients, one cluster after the other, and what they
  /// keep of its square.
  double solve(Index slice, std::span<const uint32_t> clusters, Eigen::Ref<Eigen::RowVectorXf> coefficient) const;
  /// Adds the cluster that explains most of what `clusters` with `coefficient` leave ([TGS06] block orthogonal matching
  /// pursuit), keeping the order.
  void extend(Index slice, std::vector<uint32_t>& clusters, const Eigen::RowVectorXf& coefficient) const;

 private:
  Index rank_;
  RowMatrix projection_;  // [slice][cluster, rank]
  RowMatrix products_;    // [cluster, rank][cluster, rank]
};

/// Of the squares of all slices, what their members keep of them.
struct KeptSquares {
  double before;  // with the members that they had; 0 where they had none
  double after;
};

/// Chooses members and coefficients of every slice anew: greedily, or those that `tensor` has where they are better, so
/// the error never rises. The same for any number of threads.
KeptSquares choose_members(const ClusterProducts& products, ClusteredTensor& tensor, const TensorOptions& options,
                           const Progress& progress);

}  // namespace velour
