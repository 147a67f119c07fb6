// Coefficients of clustered tensors as bytes.
#pragma once

#include "compress/tensor_texels.h"

namespace velour {

/// Sets scales of the clusters, and members and bytes of the levels of `side`, whose clusters are set and whose levels
/// are as large as they will be. A scale reaches from the least to the largest value on all levels; what rounding one
/// coefficient does to a texel is made up for by those after it (rounding_moves).
void set_rounded(const TensorFunctions& functions, std::vector<TensorTexelValues> levels, TensorSide& side);

}  // namespace velour
