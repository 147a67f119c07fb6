// A BTF as clustered tensors, evaluated.
//
// f is a product of four factors with a core between them, and what order they are multiplied in decides what it costs.
// A hit asks for one place and one view and for many lights. So what needs neither is done once, when the model is
// loaded: the core times the rows of the view's factor, a matrix [rank of the texels] x [rank of the lights, and
// colour] for every cluster and captured view. A hit multiplies those of the three views about its own with the
// coefficients of the clusters it meets, which leaves one row over the rank of the lights for every cluster and
// channel; a light is then three rows of a factor, interpolated, times those. Pictures, whose texels share view and
// light, go the other way round (tensor_images.h).
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "btf/relief.h"
#include "btf/tensor_sums.h"
#include "srbf/aligned_array.h"

namespace velour {

/// Immutable; calls are thread-safe and do not allocate.
class TensorEvaluator {
 public:
  using Point = TensorPoint;

  explicit TensorEvaluator(std::shared_ptr<const TensorBtf> btf);
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

  /// Of the cores times all views, on one side. Above it the views are left to the hit, which then sums over the rank
  /// of the views instead of three of them.
  static constexpr uint64_t kMostTableBytes = uint64_t{128} << 20;

 private:
  struct Side;
  std::shared_ptr<const TensorBtf> btf_;
  std::vector<std::unique_ptr<const Side>> sides_;
};

}  // namespace velour
