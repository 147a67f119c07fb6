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

/// A side, contracted as far as no query is needed.
struct TensorTables {
  uint32_t clusters, rank, color_rank, light_rank;  // that of the lights is padded
  const float *least, *step;                        // [cluster][padded rank]: of bytes
  const float* color;                               // [cluster][channel][rank]
  const float* view;                                // [view][cluster][rank], where `table` is of ranks; else null
  uint32_t view_rank;
  const float* table;  // [view, or rank of the views][cluster][rank][rank of the colours][padded rank of the lights]
  const float* light;  // [light][cluster][padded rank of the lights]

  size_t table_row() const { return size_t{color_rank} * light_rank; }
  size_t table_cluster() const { return rank * table_row(); }
  size_t table_node() const { return clusters * table_cluster(); }
};

/// From the bytes and shares of a point to what multiplies the light: the view is contracted with the texels.
void contract_view(const TensorTables& tables, const DirectionMesh::Weights& view, TensorPoint& point);

/// The sum of each channel under a light.
Vec3 contract_light(const TensorTables& tables, const DirectionMesh::Weights& light, const TensorPoint& point);

}  // namespace velour
