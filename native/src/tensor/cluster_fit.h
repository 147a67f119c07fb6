// Fits of clustered tensors: CTA and K-CTA.
#pragma once

#include "job/progress.h"
#include "tensor/clustered_tensor.h"

namespace velour {

enum class ClusterStart { directions, random };

struct ClusterOptions {
  Index clusters = 1, members = 1;  // C, and K <= C
  std::vector<Index> ranks{};       // of the slices' mode, then of the others; more than there is to span is cut
  int iterations = 30;              // at most, for each number of members
  double tolerance = 1e-4;          // of the squares of all slices: an iteration that gains less is the last
  int restarts = 1;                 // seeds; the best is returned
  ClusterStart start = ClusterStart::directions;
  const RowMatrix* coordinates = nullptr;  // slice_coordinates of twice the rank of the slices or more, where known
  TensorOptions tensor{};
};

struct ClusterFit {
  ClusteredTensor tensor;
  double square = 0;                // of all slices
  std::vector<double> error;        // squared, after every step of the best start: never rises
  std::vector<double> start_error;  // squared, of every start at its end
};

/// Alternates between clusters and members. Clusters: of the slices that have one, what their other clusters leave is
/// decomposed anew, beginning with its factors as they are (hooi_sweep), so the error never rises; one that nobody has
/// is begun anew with the slices that are worst off. Members: choose_members. With several members first one is fitted,
/// then two, and so on. Mode 0 of `slices` is clustered; row-major. The same for any number of threads.
/// Throws Error(invalid_argument) for counts that do not fit each other, and for slices that are not finite.
ClusterFit fit_clusters(const TensorView& slices, const ClusterOptions& options, Progress& progress);

}  // namespace velour
