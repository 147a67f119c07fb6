// Pictures of a BTF as clustered tensors.
#pragma once

#include <memory>
#include <vector>

#include "btf/tensor_btf.h"

namespace velour {

/// f of every texel of the finest level for one pair of directions, [row][column][channel]; zero where the model has no
/// side for the pair. All texels share the pair, so it is contracted first: each cluster becomes one vector over the
/// texels' rank and colour, and a texel costs as many products as it has coefficients. Evaluation at points goes the
/// other way (tensor_evaluator.h).
class TensorImages {
 public:
  /// Keeps a reference.
  explicit TensorImages(const TensorBtf& btf);
  ~TensorImages();
  /// Thread-safe.
  void image(const DirectionPair& pair, std::vector<float>& rgb) const;

 private:
  struct Side;
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace velour
