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

#include <memory>
#include <optional>
#include <vector>

#include "btf/relief.h"
#include "btf/tensor_point.h"
#include "sphere/direction_mesh.h"

namespace velour {

/// Immutable; calls are thread-safe and do not allocate.
class TensorEvaluator {
 public:
  using Point = TensorPoint;

  explicit TensorEvaluator(std::shared_ptr<const TensorBtf> btf, uint64_t most_bytes = kMostTableBytes);
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
  static constexpr uint64_t kMostTableBytes = uint64_t{128} << 20;

 private:
  struct Level;
  struct Side;
  std::shared_ptr<const TensorBtf> btf_;
  std::vector<std::unique_ptr<const Side>> sides_;
};

}  // namespace velour
