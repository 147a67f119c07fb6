// Clustered tensors (CTA and K-CTA), and the choice of the clusters that represent a slice.
#pragma once

#include <cstdint>
#include <span>
#include "math/tensor/decompositions.h"

namespace velour {

// Clustered tensors (CTA and K-CTA), whose slices are sums of a few clusters.

/// A cluster: the Tucker decomposition of its slices without the factor of the slice mode. The rows of its basis,
/// core x_1 factor[0] x_2 factor[1] ..., are orthonormal.
struct TensorCluster {
  std::vector<RowMatrix> factor;  // of the modes after the slice mode, extent x rank, orthonormal columns
  RowMatrix core;                 // rank of the slices x product of the other ranks; orthonormal rows

  /// Returns [rank][entry of a slice].
  RowMatrix basis(const TensorOptions& options, const Progress& progress) const;
};

/// Slice i (index i of mode 0) ~ sum over k < members of basis(member(i, k))^T coefficient(i, k): clustered tensor
/// approximation with one member ([T06]), its sparse generalization K-CTA with more ([T09]). The storage and the fit
/// are our own.
struct ClusteredTensor {
  std::vector<Index> extent;  // slice mode first
  std::vector<TensorCluster> cluster;
  Index members = 1;             // K: clusters per slice
  std::vector<uint32_t> member;  // [slice][k], distinct, ascending
  RowMatrix coefficient;         // [slice][k, rank]

  Index slices() const { return extent[0]; }
  Index rank() const { return cluster[0].core.rows(); }
  Index size() const;  // entries of a slice
  /// Number of stored values: cores, factors, coefficients.
  Index parameters() const;
};

/// Reconstructs the slices.
DenseTensor expanded(const ClusteredTensor& tensor, const TensorOptions& options, const Progress& progress);

// Choice of the clusters that represent a slice.

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
