// Query-independent contraction of a side of clustered tensors.
#pragma once

#include <cstdint>

#include "base/aligned_array.h"
#include "btf/model/tensor_sums.h"

namespace velour {

struct TensorFactors;

/// Owns the arrays of its TensorTables. Immutable.
class TensorContraction {
 public:
  /// Uses the first TensorOrder whose tables fit into `most_bytes`; those of TensorOrder::ranks may exceed it.
  TensorContraction(const TensorBtf& btf, const TensorSide& side, uint64_t most_bytes);
  const TensorTables& tables() const { return tables_; }
  /// Size of the contraction of such a side, whatever its values.
  static uint64_t bytes(const TensorBtf& btf, const TensorSide& side, uint64_t most_bytes);

 private:
  void scale_from(const TensorSide& side);
  void fill_cluster(const TensorSide& side, const TensorFactors& factors, size_t cluster);
  void fill_lights(const TensorSide& side, const TensorFactors& factors, size_t cluster);
  void fill_pairs(const TensorSide& side, const TensorFactors& factors, size_t cluster);

  uint32_t views_;
  TensorTables tables_;
  AlignedArray<float> least_, step_, color_, view_, table_, light_;
};

}  // namespace velour
