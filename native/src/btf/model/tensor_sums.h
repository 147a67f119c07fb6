// Inner loops of clustered-tensor evaluation. Run-time dispatched SIMD.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "btf/model/tensor_evaluator.h"
#include "math/sphere/direction_mesh.h"

namespace velour {

/// Texels of a periodic tile, [row][column][record]: the indices of a texel's clusters, then the coefficient bytes of
/// each cluster. Up to kRankPadding bytes past the last record are read.
struct TensorTexels {
  const uint8_t* records;
  uint32_t width, height;
  uint32_t members, rank;
  uint32_t stride() const { return members * (1 + rank); }
};

/// Adds `weight` times the four texels around `texel` (bilinear_at) to the bytes and shares of the point.
void add_tensor_texels(const TensorTexels& texels, const Vec2& texel, float weight, TensorPoint& point);

/// How far a side is contracted in advance. Earlier orders need larger tables and leave less work per query.
enum class TensorOrder {
  pairs,  // all factors but the texels', for every pair of directions
  views,  // the views' factor, for every view; texels and lights remain
  ranks,  // nothing; all factors remain
};

/// Query-independent contraction of a side. A point has a row of `width` numbers per cluster and channel: [light rank],
/// or for TensorOrder::pairs [color rank][texel rank]; both padded.
struct TensorTables {
  TensorOrder order;
  uint32_t clusters, rank, color_rank, width;
  const float *least, *step;  // [cluster][padded rank]: scales of bytes
  const float* color;         // [cluster][channel][rank]
  const float* view;          // [view][cluster][rank], for TensorOrder::ranks
  uint32_t view_rank;
  const float* table;  // [view or view rank][cluster][rank][color rank][width], not for pairs
  const float* light;  // multiplies the rows: [light][cluster][width], for pairs [view][light][cluster][width]
  uint32_t lights;

  size_t table_row() const { return size_t{color_rank} * width; }
  size_t table_cluster() const { return rank * table_row(); }
  size_t table_node() const { return clusters * table_cluster(); }
  size_t light_node() const { return size_t{clusters} * width; }
};

/// Converts the bytes and shares of a point to the rows that are multiplied by the light.
void contract_view(const TensorTables& tables, const DirectionMesh::Weights& view, TensorPoint& point);

/// The sum of each channel under a light.
Vec3 contract_light(const TensorTables& tables, const DirectionMesh::Weights& light, const TensorPoint& point);

}  // namespace velour
