// Rounding of the coefficients of clustered tensors to bytes.
#pragma once

#include "compress/tensor_texels.h"

namespace velour {

/// Sets the scales of the clusters and the members and bytes of the levels of `side`, whose clusters and level sizes
/// are set. A scale spans the values of all levels; the effect of rounding a coefficient on a texel is compensated by
/// the coefficients after it (rounding_moves).
void set_rounded(const TensorFunctions& functions, std::vector<TensorTexelValues> levels, TensorSide& side);

}  // namespace velour
