// Sizes of the parts of clustered tensors.
#pragma once

#include <cstdint>

#include "btf/tensor_btf.h"

namespace velour {

/// Bytes of one side, as stored.
struct TensorBytes {
  uint64_t coefficients = 0, members = 0, relief = 0;  // over all levels
  uint64_t factors = 0, cores = 0, scales = 0;         // over all clusters
};
TensorBytes bytes_of(const TensorSide& side);

}  // namespace velour
