// The number and ranks of the clusters of a clustered-tensor model.
#pragma once

#include <optional>
#include <vector>

#include "btf/tensor_btf.h"

namespace velour {

struct TensorShape {
  uint32_t clusters = 1, members = 1;
  TensorSide::Ranks rank{1, 1, 1, 1};

  /// Coefficients per texel.
  uint32_t coefficients() const { return members * rank.texel; }
  /// Directional functions of all clusters.
  uint32_t functions() const { return clusters * rank.texel; }
};

/// Sizes of a side that determine its shapes.
struct TensorExtent {
  uint64_t texels = 0;             // texels of all levels
  uint64_t finest = 0;             // texels of the finest level
  uint64_t views = 0, lights = 0;  // views and lights of the side
  bool relief = false;
  uint32_t view_rank = 0, light_rank = 0;  // upper bounds
  uint32_t functions = 640;                // upper bound
};

/// Stored size: TensorSide::parameter_bytes().
uint64_t tensor_bytes(const TensorShape& shape, const TensorExtent& extent);

/// A shape to try: clusters, members, color rank, and the texels' share of the bytes.
struct ShapeChoice {
  uint32_t clusters = 1, members = 1, colors = 3;
  double texel_share = 0.6;
};

/// The largest shape within the bytes: the texel rank from the texels' share, the ranks of views and lights from the
/// rest. No rank exceeds its extent. Empty if not even ranks of 1 fit.
std::optional<TensorShape> largest_shape(const ShapeChoice& choice, const TensorExtent& extent, uint64_t bytes);

}  // namespace velour
