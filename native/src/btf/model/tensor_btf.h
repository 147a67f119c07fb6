// A BTF as clustered tensors: CTA, K-CTA, or (with one cluster) a Tucker decomposition.
#pragma once

#include <cstdint>
#include <vector>
#include "btf/model/srbf_btf.h"

namespace velour {

/// Direction and color part of a cluster: a core [texel rank][view rank][light rank][color rank] and a factor per mode.
/// A texel's contribution is a weighted sum of the core's rows.
struct TensorBtfCluster {
  std::vector<HalfBits> view;    // [view of the side][rank]
  std::vector<HalfBits> light;   // [light of the side][rank]
  std::vector<HalfBits> color;   // [axis][rank]
  std::vector<HalfBits> core;    // [texel rank][view rank][light rank][color rank]
  std::vector<ByteScale> scale;  // per texel coefficient, shared by all levels
};

/// One mip level of the tile.
struct TensorLevel {
  uint32_t width = 0, height = 0;
  std::vector<HalfBits> relief;  // [row][column]: height over the reference plane, in tile widths; empty: flat
  std::vector<uint8_t> member;   // [row][column][k]: index of a cluster
  std::vector<uint8_t> value;    // [row][column][k][rank]; see TensorBtfCluster::scale of that cluster
};

/// Appearance from one side of the reference plane under light from one side. Its directions are those of the layout on
/// these sides, in order, mirrored to z > 0.
///
/// Let p be the point where the view ray hits the relief of the level (Relief::seen; without a relief: the texel's own
/// place). For color axis a, view v and light l, the sum at p is
///   s_a = sum over the members c of p, and over ranks r, of value_{c,r}(p) basis_{c,r}(v, l, a),
///   basis_{c,r}(v, l, a) = sum over ranks of core_c(r, i, j, k) view_c(v, i) light_c(l, j) color_c(a, k).
/// The factors are interpolated between views and between lights (PairInterpolation), the sums between texels, and f
/// = expanded(axes (s_0, s_1, s_2)).
struct TensorSide {
  bool view_below = false, light_below = false;
  struct Ranks {
    uint32_t texel = 0, view = 0, light = 0, color = 0;
  } rank;
  uint32_t members = 1;  // number of distinct clusters per texel
  std::vector<TensorBtfCluster> clusters;
  std::vector<TensorLevel> levels;  // finest first; each half the size of the previous one, down to one texel

  /// Size of all coefficients, members, heights, factors and cores as stored.
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
  /// Maximum of a side's number of clusters times its texel rank, and times its light rank, each rounded up to a
  /// multiple of kRankPadding: the storage of a point that meets all clusters.
  static constexpr size_t kMaxClusterRanks = 4096;
};

/// Vectors over ranks are evaluated in whole blocks of this many floats.
inline constexpr uint32_t kRankPadding = 16;
inline uint32_t padded_rank(uint32_t rank) { return (rank + kRankPadding - 1) / kRankPadding * kRankPadding; }

// Sizes of the parts of clustered tensors.

/// Bytes of one side, as stored.
struct TensorBytes {
  uint64_t coefficients = 0, members = 0, relief = 0;  // over all levels
  uint64_t factors = 0, cores = 0, scales = 0;         // over all clusters
};
TensorBytes bytes_of(const TensorSide& side);

// The factors of clustered tensors as floats.

/// TensorBtfCluster as floats, with colors in linear Rec. 709 instead of along the axes.
struct TensorFactors {
  TensorFactors(const TensorBtf& btf, const TensorBtfCluster& cluster);
  std::vector<float> view;   // [view][rank]
  std::vector<float> light;  // [light][rank]
  std::vector<float> color;  // [channel][rank]
  std::vector<float> core;   // [texel rank][view rank][light rank][color rank]
};

/// Heights of a level that has a relief.
std::vector<float> heights_of(const TensorLevel& level);

}  // namespace velour
