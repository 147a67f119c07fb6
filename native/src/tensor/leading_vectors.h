// Bases of the modes of tensors.
#pragma once

#include <cstdint>

#include "job/progress.h"
#include "tensor/tensor_view.h"

namespace velour {

/// How bases are found; results do not depend on `threads`.
struct TensorOptions {
  uint64_t seed = 0;  // of random starts
  int threads = 0;    // 0: all
};

/// The `rank` leading left singular vectors of a mode's unfolding, as orthonormal columns, the strongest first. By the
/// eigenvectors of its products with itself on the shorter side; where both sides are longer than 1024, of random_range
/// with some columns more.
RowMatrix leading_vectors(const TensorView& view, size_t mode, Index rank, const TensorOptions& options,
                          const Progress& progress);

/// Orthonormal columns that span about what the leading left singular vectors do: the unfolding times random columns,
/// `powers` times multiplied by the unfolding and its transpose ([HMT11] algorithm 4.4).
RowMatrix random_range(const TensorView& view, size_t mode, Index columns, int powers, const TensorOptions& options,
                       const Progress& progress);

}  // namespace velour
