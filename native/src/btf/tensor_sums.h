// The inner loops of clustered tensors. Run-time dispatched SIMD.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "btf/tensor_point.h"
#include "sphere/direction_mesh.h"

namespace velour {

/// Texels of a tile that repeats, [row][column][record]: numbers of a texel's clusters, then of each of those the bytes
/// of its coefficients. kRankPadding bytes more are read behind the last one.
struct TensorTexels {
  const uint8_t* records;
  uint32_t width, height;
  uint32_t members, rank;
  uint32_t stride() const { return members * (1 + rank); }
};

/// Adds `weight` times the four texels about `texel` (bilinear_at) to the point: bytes and shares.
void add_tensor_texels(const TensorTexels& texels, const Vec2& texel, float weight, TensorPoint& point);

/// What of a query its factors are contracted with last: the earlier, the larger the tables and the less is left.
enum class TensorOrder {
  pairs,  // all but texels, for every pair of directions
  views,  // texels and lights, for every view
  ranks,  // all of them
};

/// A side, contracted as far as no query is needed. A point has a row of `width` numbers for every cluster and channel:
/// [rank of the lights], or in order of pairs [rank of the colours][rank of the texels]; both padded.
struct TensorTables {
  TensorOrder order;
  uint32_t clusters, rank, color_rank, width;
  const float *least, *step;  // [cluster][padded rank]: of bytes
  const float* color;         // [cluster][channel][rank]
  const float* view;          // [view][cluster][rank], in order of ranks
  uint32_t view_rank;
  const float* table;  // [view, or rank of the views][cluster][rank][rank of the colours][width], not of pairs
  const float* light;  // what rows are multiplied by: [light][cluster][width], of pairs [view][light][cluster][width]
  uint32_t lights;

  size_t table_row() const { return size_t{color_rank} * width; }
  size_t table_cluster() const { return rank * table_row(); }
  size_t table_node() const { return clusters * table_cluster(); }
  size_t light_node() const { return size_t{clusters} * width; }
};

/// From the bytes and shares of a point to what multiplies the light.
void contract_view(const TensorTables& tables, const DirectionMesh::Weights& view, TensorPoint& point);

/// The sum of each channel under a light.
Vec3 contract_light(const TensorTables& tables, const DirectionMesh::Weights& light, const TensorPoint& point);

}  // namespace velour
