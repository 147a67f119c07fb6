// Fits of clustered tensors: CTA and K-CTA.
#pragma once

#include <span>
#include "base/progress.h"
#include "math/tensor/cluster_choice.h"
#include "math/tensor/decompositions.h"

namespace velour {

struct ClusterOptions {
  Index clusters = 1, members = 1;         // C, and K <= C
  std::vector<Index> ranks{};              // of the slice mode, then of the others; limited to the extents
  int iterations = 30;                     // maximum for each number of members
  double tolerance = 1e-4;                 // relative to the squared norm of all slices; stops at smaller gains
  const RowMatrix* coordinates = nullptr;  // slice_coordinates of at least twice the rank of the slices, if known
  TensorOptions tensor{};
};

struct ClusterFit {
  ClusteredTensor tensor;
  double square = 0;          // squared norm of all slices
  std::vector<double> error;  // squared, after every step; never rises
};

/// Alternates between clusters and members. A cluster is refitted to the residuals that the other clusters of its
/// slices leave, starting from its current factors (hooi_sweep), so the error never rises; an empty cluster restarts
/// with the slices of the largest error. Members: choose_members. With several members, first one is fitted, then two,
/// and so on. Clusters mode 0 of `slices`, which is row-major. The result does not depend on the number of threads.
/// Throws Error(invalid_argument) for inconsistent counts and for slices that are not finite.
ClusterFit fit_clusters(const TensorView& slices, const ClusterOptions& options, Progress& progress);

// Residuals of clustered slices.

/// Residuals [slice of `which`][entry]: slices minus the parts of all their clusters except `but`; an index past the
/// last cluster excludes none. `slices`: row-major; `basis`: one per cluster. Slices without members stay unchanged.
/// Bit-identical for any number of threads.
DenseTensor cluster_rests(const TensorView& slices, const ClusteredTensor& tensor, const std::vector<RowMatrix>& basis,
                          std::span<const Index> which, uint32_t but, const TensorOptions& options,
                          const Progress& progress);

// Initial clusters.

/// Coordinates [slice][coordinate] of slices ([slice][entry]) in the space of their `rank` leading right singular
/// vectors, strongest first.
RowMatrix slice_coordinates(const TensorView& slices, Index rank, const TensorOptions& options,
                            const Progress& progress);

/// Clusters slices by k-means ([AV07] seeds) on the directions of their coordinates, because a cluster of a Tucker
/// decomposition is a linear subspace. Returns the cluster of each slice.
std::vector<uint32_t> clusters_by_direction(RowMatrix coordinates, Index clusters, uint64_t seed);

}  // namespace velour
