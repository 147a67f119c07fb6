// A BTF as sums of multivariate SRBFs, evaluated.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "btf/relief.h"
#include "btf/srbf_point.h"
#include "srbf/aligned_array.h"

namespace velour {

/// Immutable; calls are thread-safe and do not allocate.
class SrbfEvaluator {
 public:
  explicit SrbfEvaluator(std::shared_ptr<const SrbfBtf> btf);

  const SrbfBtf& btf() const { return *btf_; }
  /// Its number; nothing where the BTF was not fitted there.
  std::optional<uint32_t> side(bool view_below, bool light_below) const;
  /// Texels of the finest level.
  Vec2 texels() const { return {btf_->grid.width, btf_->grid.height}; }

  /// Begins a point, seen from `wv`. Then add() its places, of weights that sum to 1, and finish().
  void begin(uint32_t side, const Vec3& wv, SrbfPoint& point) const;
  /// `uv`: in tiles, on the reference plane; `level` of the pyramid, between 0 and the last.
  void add(const Vec2& uv, float level, float weight, SrbfPoint& point) const;
  void finish(SrbfPoint& point) const;
  /// f of a finished point, never negative. `wl` as wv: in the frame of its side.
  Rgb value(const SrbfPoint& point, const Vec3& wl) const;

 private:
  /// A texel is a record of halves: coefficients of axis 0 by padded lobe (tile's, then texels'), those of axes 1 and 2
  /// one after the other, the slope of the relief; padded.
  struct Level {
    Relief relief;
    AlignedArray<HalfBits> record;  // [row][column][record], whole cache lines
  };
  struct Side {
    Side(const SrbfBtf& btf, const SrbfSide& side);
    uint32_t place_of(uint16_t lobe) const;

    MultivariateLobes tile, texel;
    uint32_t axis1 = 0, slope = 0, stride = 0;     // places in a record
    std::array<std::vector<uint32_t>, 2> scatter;  // of axes 1, 2: the padded lobe of each coefficient
    std::vector<Level> levels;
  };

  void add_bilinear(const Level& level, uint32_t stride, const Vec2& place, float weight, SrbfPoint& point) const;

  std::shared_ptr<const SrbfBtf> btf_;
  std::vector<Side> sides_;
};

/// f of every texel of the finest level for one pair of directions, [row][column][channel]; zero where the model has no
/// direction on a side of the plane.
void srbf_image(const SrbfEvaluator& evaluator, const DirectionPair& pair, std::vector<float>& rgb);

}  // namespace velour
