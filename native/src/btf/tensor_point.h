// A point of a clustered-tensor BTF seen from one view.
#pragma once

#include <cstdint>

#include "btf/tensor_btf.h"
#include "sphere/direction_mesh.h"

namespace velour {

/// Scratch memory of TensorEvaluator, reused from hit to hit. Holds the clusters of the point's texels in the order in
/// which they were met; only that part is touched. Directions are in the frame of the side, z > 0.
struct TensorPoint {
  static constexpr size_t kMostRanks = TensorBtf::kMaxClusterRanks, kMostClusters = TensorBtf::kMaxClusters;
  static constexpr uint16_t kNotMet = 0xffff;

  alignas(64) float coefficient[kMostRanks];  // [met][padded texel rank]
  // [met][channel][TensorTables::width]: multiplied by the light. Padded, because rows may be written past their end.
  alignas(64) float row[3 * kMostRanks + kRankPadding];
  DirectionMesh::Weights view;
  float share[kMostClusters];      // [met]: total weight of its texels
  uint16_t met[kMostClusters];     // [cluster]: its index in that order, or kNotMet
  uint8_t cluster[kMostClusters];  // [met]
  uint32_t count;
  uint32_t side;
  Vec3 wv;
  Vec2 slope;  // slope of the relief, see Relief::slope
  bool seen;   // set by the caller; false where the BTF was not fitted
};

}  // namespace velour
