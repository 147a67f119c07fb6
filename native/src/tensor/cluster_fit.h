// Fits of clustered tensors: CTA and K-CTA.
#pragma once

#include "job/progress.h"
#include "tensor/clustered_tensor.h"

namespace velour {

enum class ClusterStart { directions, random };

struct ClusterOptions {
  Index clusters = 1, members = 1;  // C, and K <= C
  std::vector<Index> ranks{};       // of the slice mode, then of the others; limited to the extents
  int iterations = 30;              // maximum for each number of members
  double tolerance = 1e-4;          // relative to the squared norm of all slices; stops at smaller gains
  int restarts = 1;                 // number of seeds; the best fit is returned
  ClusterStart start = ClusterStart::directions;
  const RowMatrix* coordinates = nullptr;  // slice_coordinates of at least twice the rank of the slices, if known
  TensorOptions tensor{};
};

struct ClusterFit {
  ClusteredTensor tensor;
  double square = 0;                // squared norm of all slices
  std::vector<double> error;        // squared, after every step of the best start; never rises
  std::vector<double> start_error;  // final squared error of every start
};

/// Alternates between clusters and members. A cluster is refitted to the residuals that the other clusters of its
/// slices leave, starting from its current factors (hooi_sweep), so the error never rises; an empty cluster restarts
/// with the slices of the largest error. Members: choose_members. With several members, first one is fitted, then two,
/// and so on. Clusters mode 0 of `slices`, which is row-major. The result does not depend on the number of threads.
/// Throws Error(invalid_argument) for inconsistent counts and for slices that are not finite.
ClusterFit fit_clusters(const TensorView& slices, const ClusterOptions& options, Progress& progress);

}  // namespace velour
