// Initial clusters.
#pragma once

#include "tensor/leading_vectors.h"

namespace velour {

/// Coordinates [slice][coordinate] of slices ([slice][entry]) in the space of their `rank` leading right singular
/// vectors, strongest first.
RowMatrix slice_coordinates(const TensorView& slices, Index rank, const TensorOptions& options,
                            const Progress& progress);

/// Clusters slices by k-means ([AV07] seeds) on the directions of their coordinates, because a cluster of a Tucker
/// decomposition is a linear subspace. Returns the cluster of each slice.
std::vector<uint32_t> clusters_by_direction(RowMatrix coordinates, Index clusters, uint64_t seed);

/// Assigns a random cluster to each slice.
std::vector<uint32_t> clusters_at_random(Index slices, Index clusters, uint64_t seed);

}  // namespace velour
