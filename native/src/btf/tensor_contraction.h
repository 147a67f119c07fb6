// A side of clustered tensors, contracted as far as no query is needed.
#pragma once

#include <cstdint>

#include "btf/tensor_sums.h"
#include "srbf/aligned_array.h"

namespace velour {

struct TensorFactors;

/// Owns what TensorTables point into. Immutable.
class TensorContraction {
 public:
  /// The earliest order whose tables take no more than `most_bytes`; in order of ranks they may.
  TensorContraction(const TensorBtf& btf, const TensorSide& side, uint64_t most_bytes);
  const TensorTables& tables() const { return tables_; }
  /// That a contraction of such a side takes, whatever is in it.
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
