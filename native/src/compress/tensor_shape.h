// How many clusters of which ranks a model of clustered tensors has.
#pragma once

#include <optional>
#include <vector>

#include "btf/tensor_btf.h"

namespace velour {

struct TensorShape {
  uint32_t clusters = 1, members = 1;
  TensorSide::Ranks rank{1, 1, 1, 1};

  /// Coefficients of a texel.
  uint32_t coefficients() const { return members * rank.texel; }
  /// Functions of the directions: of all clusters.
  uint32_t functions() const { return clusters * rank.texel; }
};

/// Of a side, what shapes follow from.
struct TensorExtent {
  uint64_t texels = 0;             // of all levels
  uint64_t finest = 0;             // of the finest level
  uint64_t views = 0, lights = 0;  // of the side
  bool relief = false;
  uint32_t view_rank = 0, light_rank = 0;  // at most
  uint32_t functions = 640;                // at most
};

/// As it is stored: TensorSide::parameter_bytes().
uint64_t tensor_bytes(const TensorShape& shape, const TensorExtent& extent);

/// What is tried: clusters, members, which part of the bytes texels have, rank of the colours.
struct ShapeChoice {
  uint32_t clusters = 1, members = 1, colors = 3;
  double texel_share = 0.6;
};

/// The largest shape within the bytes: ranks of texels by their share, those of views and lights by what is left. No
/// rank is more than there is to span. Nothing where that is not one of each.
std::optional<TensorShape> largest_shape(const ShapeChoice& choice, const TensorExtent& extent, uint64_t bytes);

}  // namespace velour
