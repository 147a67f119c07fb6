// Evaluation of BTFs made of clustered tensors.
//
// f is a product of four factors and a core; the order of multiplication determines the cost. A hit needs one place,
// one view and some lights, so everything independent of them is computed once, when the model is loaded: if memory
// allows, the core and factors are contracted for every pair of captured directions to a vector [texel rank, color] per
// cluster. A hit multiplies the coefficients of its clusters by their colors; a light is then the dot product of those
// with the vectors of the three by three surrounding views and lights, interpolated. If these vectors would take too
// much memory, the core is contracted with the views alone: a hit contracts those of its three views, at ten times the
// cost, and a light is three rows of a factor (TensorOrder). Images, whose texels share view and light, use the reverse
// order (tensor_images.h).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>
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

}  // namespace velour
