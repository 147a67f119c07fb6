// A BTF as clustered tensors: CTA and K-CTA, and with one cluster a Tucker decomposition.
#pragma once

#include <cstdint>
#include <vector>

#include "btf/sides.h"
#include "btf/srbf_btf.h"

namespace velour {

/// Directions' and colours' part of a cluster, [rank of the texels][rank of the views][of the lights][of the colours]
/// times a factor a mode. What a texel adds is a sum of its rows.
struct TensorBtfCluster {
  std::vector<HalfBits> view;    // [view of the side][rank]
  std::vector<HalfBits> light;   // [light of the side][rank]
  std::vector<HalfBits> color;   // [axis][rank]
  std::vector<HalfBits> core;    // [texels'][views'][lights'][colours' rank]
  std::vector<ByteScale> scale;  // of a texel's coefficients, on all levels
};

/// One level of the pyramid over the tile.
struct TensorLevel {
  uint32_t width = 0, height = 0;
  std::vector<HalfBits> relief;  // [row][column]: over the reference plane, widths of the tile; empty: a plane
  std::vector<uint8_t> member;   // [row][column][k]: a cluster
  std::vector<uint8_t> value;    // [row][column][k][rank]: that cluster's TensorBtfCluster::scale
};

/// What is seen from one side of the reference plane under light from one side; its directions are those of that side,
/// in the layout's order, mirrored to z > 0.
///
/// Let p be where the view's ray meets the relief of the level (Relief::seen; without one: the texel's own place). With
/// a = a colour axis, v = a view, l = a light, the sum at p is
///   s_a = sum over the members c of p, and over ranks r, of value_{c,r}(p) basis_{c,r}(v, l, a),
///   basis_{c,r}(v, l, a) = sum over ranks of core_c(r, i, j, k) view_c(v, i) light_c(l, j) color_c(a, k),
/// between views and between lights with their factors interpolated (pair_interpolation.h), between texels with the
/// sums of each of them, and f = expanded(axes (s_0, s_1, s_2)).
struct TensorSide {
  bool view_below = false, light_below = false;
  struct Ranks {
    uint32_t texel = 0, view = 0, light = 0, color = 0;
  } rank;
  uint32_t members = 1;  // clusters that a texel is made of, distinct
  std::vector<TensorBtfCluster> clusters;
  std::vector<TensorLevel> levels;  // the finest first; each half of the one before, down to one texel

  /// Of all coefficients, members, heights, factors and cores as they are stored.
  uint64_t parameter_bytes() const;
};

struct TensorBtf {
  PairLayout layout;  // complete
  TexelGrid grid;
  Companding companding = Companding::root;
  Mat3 axes{1.0f};  // columns: orthonormal directions in RGB
  std::vector<TensorSide> sides;
  std::vector<SharedSide> shared = {};

  uint64_t parameter_bytes() const;

  static constexpr size_t kMaxClusters = 256, kMaxMembers = 8, kMaxRank = 256;
  /// Of a side's clusters times the rank of its texels, and times that of its lights, each rounded up to a multiple of
  /// kRankPadding: what a point that meets all clusters has to hold.
  static constexpr size_t kMaxClusterRanks = 4096;
};

/// Vectors over ranks are evaluated in whole blocks of this many floats.
inline constexpr uint32_t kRankPadding = 16;
inline uint32_t padded_rank(uint32_t rank) { return (rank + kRankPadding - 1) / kRankPadding * kRankPadding; }

}  // namespace velour
