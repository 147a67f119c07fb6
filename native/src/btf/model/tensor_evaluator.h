// Evaluation of BTFs made of clustered tensors.
//
// f is a product of four factors and a core; the order of multiplication determines the cost. A hit needs one place,
// one view and some lights, so everything independent of them is computed once, when the model is loaded: if memory
// allows, the core and factors are contracted for every pair of captured directions to a vector [texel rank, color] per
// cluster. A hit multiplies the coefficients of its clusters by their colors; a light is then the dot product of those
// with the vectors of the three by three surrounding views and lights, interpolated. If these vectors would take too
// much memory, the core is contracted with the views alone: a hit contracts those of its three views, at ten times the
// cost, and a light is three rows of a factor (TensorOrder). Images, whose texels share view and light, use the reverse
// order (TensorImages).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>
#include "base/memory.h"
#include "btf/measure/relief.h"
#include "btf/model/tensor_btf.h"
#include "math/sphere/direction_mesh.h"

namespace velour {

// A point of a clustered-tensor BTF seen from one view.

/// Scratch memory of TensorEvaluator, reused from hit to hit. Holds the clusters of the point's texels in the order in
/// which they were met; only that part is touched. Directions are in the frame of the side, z > 0.
struct TensorPoint {
  static constexpr size_t kMaxRanks = TensorBtf::kMaxClusterRanks, kMaxClusters = TensorBtf::kMaxClusters;
  static constexpr uint16_t kNotMet = 0xffff;

  alignas(64) float coefficient[kMaxRanks];  // [met][padded texel rank]
  // [met][channel][TensorTables::width]: multiplied by the light. Padded, because rows may be written past their end.
  alignas(64) float row[3 * kMaxRanks + kRankPadding];
  DirectionMesh::Weights view;
  float share[kMaxClusters];      // [met]: total weight of its texels
  uint16_t met[kMaxClusters];     // [cluster]: its index in that order, or kNotMet
  uint8_t cluster[kMaxClusters];  // [met]
  uint32_t count;
  uint32_t side;
  Vec3 wv;
  Vec2 slope;  // slope of the relief, see Relief::slope
  bool seen;   // set by the caller; false where the BTF was not fitted
};

/// Immutable; calls are thread-safe and do not allocate.
class TensorEvaluator {
 public:
  using Point = TensorPoint;

  explicit TensorEvaluator(std::shared_ptr<const TensorBtf> btf, uint64_t most_bytes = kMaxTableBytes);
  ~TensorEvaluator();

  const TensorBtf& btf() const { return *btf_; }
  /// Index of the side; empty if the BTF was not fitted there.
  std::optional<uint32_t> side(bool view_below, bool light_below) const;
  /// Texels of the finest level.
  Vec2 texels() const { return {btf_->grid.width, btf_->grid.height}; }

  /// Begins a point seen from `wv`. Call add() for each of its places, with weights that sum to 1, then finish().
  void begin(uint32_t side, const Vec3& wv, TensorPoint& point) const;
  /// `uv`: in tiles, on the reference plane. `level`: mip level, from 0 to the last.
  void add(const Vec2& uv, float level, float weight, TensorPoint& point) const;
  void finish(TensorPoint& point) const;

  /// The three lights around a direction, computed once for many points.
  using Light = DirectionMesh::Weights;
  Light light(uint32_t side, const Vec3& wl) const;
  /// f at a finished point, never negative. `wl`, like `wv`, is in the frame of the side.
  Rgb value(const TensorPoint& point, const Light& light) const;
  Rgb value(const TensorPoint& point, const Vec3& wl) const { return value(point, light(point.side, wl)); }
  /// Mean normal of the visible relief.
  Vec3 normal(const TensorPoint& point) const { return glm::normalize(Vec3(point.slope, 1)); }

  /// Maximum size of a side's tables.
  static constexpr uint64_t kMaxTableBytes = uint64_t{128} << 20;

 private:
  struct Level;
  struct Side;
  std::shared_ptr<const TensorBtf> btf_;
  std::vector<std::unique_ptr<const Side>> sides_;
};

// Inner loops of clustered-tensor evaluation. Run-time dispatched SIMD.

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

// Query-independent contraction of a side of clustered tensors.

struct TensorFactors;

/// Owns the arrays of its TensorTables. Immutable.
class TensorContraction {
 public:
  /// Uses the first TensorOrder whose tables fit into `most_bytes`; those of TensorOrder::ranks may exceed it.
  TensorContraction(const TensorBtf& btf, const TensorSide& side, uint64_t most_bytes);
  const TensorTables& tables() const { return tables_; }
  /// Size of the contraction of such a side, whatever its values.
  static uint64_t bytes(const TensorBtf& btf, const TensorSide& side, uint64_t most_bytes);

 private:
  void scale_from(const TensorSide& side);
  void fill_cluster(const TensorSide& side, const TensorFactors& factors, size_t cluster);
  void fill_lights(const TensorSide& side, const TensorFactors& factors, size_t cluster);
  void fill_pairs(const TensorSide& side, const TensorFactors& factors, size_t cluster);

  uint32_t views_;
  TensorTables tables_;
  AlignedArray<float> least_, step_, color_, view_, table_, light_;
};

// Images of BTFs made of clustered tensors.

/// Computes f of every texel of the finest level for one pair of directions, [row][column][channel]; zero if the model
/// has no side for the pair. All texels share the pair, so it is contracted first: each cluster becomes one vector over
/// texel rank and color, and a texel costs one product per coefficient and channel. Evaluation at points uses the
/// reverse order (TensorEvaluator).
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
