// Where the search for clusters begins.
#pragma once

#include "tensor/leading_vectors.h"

namespace velour {

/// A cluster of each slice ([slice][entry]): k-means ([AV07] seeds) of the directions of slices within the space of
/// their `rank` leading right singular vectors, since a cluster of a Tucker decomposition is a space through 0.
std::vector<uint32_t> clusters_by_direction(const TensorView& slices, Index clusters, Index rank,
                                            const TensorOptions& options, const Progress& progress);

/// Of each slice a cluster at random.
std::vector<uint32_t> clusters_at_random(Index slices, Index clusters, uint64_t seed);

}  // namespace velour
