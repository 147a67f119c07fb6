// Images of BTFs made of clustered tensors.
#pragma once

#include <memory>
#include <vector>

#include "btf/model/tensor_btf.h"

namespace velour {

/// Computes f of every texel of the finest level for one pair of directions, [row][column][channel]; zero if the model
/// has no side for the pair. All texels share the pair, so it is contracted first: each cluster becomes one vector over
/// texel rank and color, and a texel costs one product per coefficient and channel. Evaluation at points uses the
/// reverse order (tensor_evaluator.h).
class TensorImages {
 public:
  /// Keeps a reference to `btf`.
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
