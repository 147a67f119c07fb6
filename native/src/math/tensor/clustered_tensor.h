// Clustered tensors (CTA and K-CTA), whose slices are sums of a few clusters.
#pragma once

#include <cstdint>

#include "math/tensor/decompositions.h"

namespace velour {

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

}  // namespace velour
