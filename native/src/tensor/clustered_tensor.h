// Tensors whose slices are made of few clusters: CTA and K-CTA.
#pragma once

#include <cstdint>

#include "tensor/tucker.h"

namespace velour {

/// A cluster: a Tucker decomposition of its slices without the factor of the slices. The rows of its basis,
/// core x_1 factor[0] x_2 factor[1] ..., are orthonormal.
struct TensorCluster {
  std::vector<RowMatrix> factor;  // of the modes behind the slices', extent x rank, orthonormal columns
  RowMatrix core;                 // rank of the slices x product of the other ranks; orthonormal rows

  /// [rank][entry of a slice].
  RowMatrix basis(const TensorOptions& options, const Progress& progress) const;
};

/// Slice i (index i of mode 0) ~ sum over k < members of basis(member(i, k))^T coefficient(i, k): clustered tensor
/// approximation with one member ([T06]), its sparse generalisation K-CTA with more ([T09]); what is stored and how it
/// is fitted is ours.
struct ClusteredTensor {
  std::vector<Index> extent;  // the slices' mode first
  std::vector<TensorCluster> cluster;
  Index members = 1;             // K: clusters that a slice is made of
  std::vector<uint32_t> member;  // [slice][k], distinct, ascending
  RowMatrix coefficient;         // [slice][k, rank]

  Index slices() const { return extent[0]; }
  Index rank() const { return cluster[0].core.rows(); }
  Index size() const;  // entries of a slice
  /// Numbers that are stored: cores, factors, coefficients.
  Index parameters() const;
};

/// The slices that it stands for.
DenseTensor expanded(const ClusteredTensor& tensor, const TensorOptions& options, const Progress& progress);

}  // namespace velour
