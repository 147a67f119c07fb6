// Where the search for clusters begins.
#pragma once

#include "tensor/leading_vectors.h"

namespace velour {

/// [slice][coordinate] in the space of the `rank` leading right singular vectors of slices ([slice][entry]), the
/// strongest first.
RowMatrix slice_coordinates(const TensorView& slices, Index rank, const TensorOptions& options,
                            const Progress& progress);

/// A cluster of each slice: k-means ([AV07] seeds) of the directions that their coordinates have, since a cluster of a
/// Tucker decomposition is a space through 0.
std::vector<uint32_t> clusters_by_direction(RowMatrix coordinates, Index clusters, uint64_t seed);

/// Of each slice a cluster at random.
std::vector<uint32_t> clusters_at_random(Index slices, Index clusters, uint64_t seed);

}  // namespace velour
