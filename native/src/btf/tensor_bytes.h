// What the parts of clustered tensors cost.
#pragma once

#include <cstdint>

#include "btf/tensor_btf.h"

namespace velour {

/// Of one side, as they are stored.
struct TensorBytes {
  uint64_t coefficients = 0, members = 0, relief = 0;  // of all levels
  uint64_t factors = 0, cores = 0, scales = 0;         // of all clusters
};
TensorBytes bytes_of(const TensorSide& side);

}  // namespace velour
