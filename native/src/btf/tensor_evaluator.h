// A BTF as clustered tensors, evaluated.
//
// f is a product of four factors with a core between them, and what order they are multiplied in decides what it costs.
// A hit asks for one place, one view and some lights. So what needs none of them is done once, when the model is
// loaded: where memory allows, core and factors are multiplied for every pair of captured directions, a vector [rank of
// the texels, and colour] for every cluster. A hit multiplies the coefficients of the clusters it meets with their
// colours; a light is then the three times three vectors of the views and lights about it, interpolated, times those.
// Where these vectors would take too much, the core is multiplied with the views alone: a hit contracts those of its
// three views, at ten times the cost, and a light is three rows of a factor (TensorOrder). Pictures, whose texels share
// view and light, go the other way round (tensor_images.h).
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
  /// Its number; nothing where the BTF was not fitted there.
  std::optional<uint32_t> side(bool view_below, bool light_below) const;
  /// Texels of the finest level.
  Vec2 texels() const { return {btf_->grid.width, btf_->grid.height}; }

  /// Begins a point, seen from `wv`. Then add() its places, of weights that sum to 1, and finish().
  void begin(uint32_t side, const Vec3& wv, TensorPoint& point) const;
  /// `uv`: in tiles, on the reference plane; `level` of the pyramid, between 0 and the last.
  void add(const Vec2& uv, float level, float weight, TensorPoint& point) const;
  void finish(TensorPoint& point) const;

  /// The three lights about a direction: for whoever asks for the same one at many points.
  using Light = DirectionMesh::Weights;
  Light light(uint32_t side, const Vec3& wl) const;
  /// f of a finished point, never negative. `wl` as wv: in the frame of its side.
  Rgb value(const TensorPoint& point, const Light& light) const;
  Rgb value(const TensorPoint& point, const Vec3& wl) const { return value(point, light(point.side, wl)); }
  /// The mean normal of the relief that is seen.
  Vec3 normal(const TensorPoint& point) const { return glm::normalize(Vec3(point.slope, 1)); }

  /// Of a side's tables.
  static constexpr uint64_t kMostTableBytes = uint64_t{128} << 20;

 private:
  struct Level;
  struct Side;
  std::shared_ptr<const TensorBtf> btf_;
  std::vector<std::unique_ptr<const Side>> sides_;
};

}  // namespace velour
