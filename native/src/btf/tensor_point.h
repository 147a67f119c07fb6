// A place of a BTF of clustered tensors and a view of it.
#pragma once

#include <cstdint>

#include "btf/tensor_btf.h"
#include "sphere/direction_mesh.h"

namespace velour {

/// Scratch memory of TensorEvaluator, reused from hit to hit: of the clusters that the place is made of, in the order
/// in which they were met. Only that much of it is touched. Directions are those of the side, z > 0.
struct TensorPoint {
  static constexpr size_t kMostRanks = TensorBtf::kMaxClusterRanks, kMostClusters = TensorBtf::kMaxClusters;
  static constexpr uint16_t kNotMet = 0xffff;

  alignas(64) float coefficient[kMostRanks];  // [met][padded rank of the texels]
  // [met][channel][TensorTables::width]: what multiplies the light; and what may be written behind it.
  alignas(64) float row[3 * kMostRanks + kRankPadding];
  DirectionMesh::Weights view;
  float share[kMostClusters];      // [met]: the weights of its texels
  uint16_t met[kMostClusters];     // number in that order of each cluster, or kNotMet
  uint8_t cluster[kMostClusters];  // [met]
  uint32_t count;
  uint32_t side;
  Vec3 wv;
  Vec2 slope;  // of the relief: Relief::slope
  bool seen;   // whoever looks sets it: false where the BTF was not fitted
};

}  // namespace velour
