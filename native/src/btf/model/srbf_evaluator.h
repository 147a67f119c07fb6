// Evaluates BTFs of multivariate SRBFs.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>
#include "base/memory.h"
#include "btf/measure/relief.h"
#include "btf/model/srbf_btf.h"
#include "image/texels.h"
#include "math/sphere/vec.h"

namespace velour {

// Bilinear interpolation of byte texels.

inline constexpr uint32_t kByteRowPadding = 16;

/// Texels of a periodic tile: [row][column][stride] bytes.
struct ByteTexels {
  const uint8_t* bytes;
  uint32_t width, height, stride;
};

/// For i < stride: to[i] += weight * step[i] * (bilinear mean of byte i at `texel`, see bilinear_at). `stride` must be
/// a multiple of kByteRowPadding; `step` and `to` must be aligned to 64 bytes. Run-time dispatched SIMD.
void add_bilinear_bytes(const ByteTexels& texels, const Vec2& texel, float weight, const float* step, float* to);

// A point of an SRBF BTF seen from one view.

/// Scratch memory of SrbfEvaluator, reused from hit to hit. Directions are in the frame of the side, z > 0.
struct SrbfPoint {
  static constexpr uint32_t kMaxRecord = 3 * SrbfBtf::kMaxLobes + 3 * kByteRowPadding;

  alignas(64) float record[kMaxRecord];  // interpolated texel record, see SrbfEvaluator
  Vec3 wv;
  Mat3 to_normal;
  uint32_t side;
  bool seen;  // set by the caller; false where the BTF was not fitted
};

/// Immutable; calls are thread-safe and do not allocate.
class SrbfEvaluator {
 public:
  using Point = SrbfPoint;

  explicit SrbfEvaluator(std::shared_ptr<const SrbfBtf> btf);

  const SrbfBtf& btf() const { return *btf_; }
  /// Index of the side; empty if the BTF was not fitted there.
  std::optional<uint32_t> side(bool view_below, bool light_below) const;
  /// Texels of the finest level.
  Vec2 texels() const { return {btf_->grid.width, btf_->grid.height}; }

  /// Begins a point seen from `wv`. Call add() for each of its places, with weights that sum to 1, then finish().
  void begin(uint32_t side, const Vec3& wv, SrbfPoint& point) const;
  /// `uv`: in tiles, on the reference plane. `level`: mip level, from 0 to the last.
  void add(const Vec2& uv, float level, float weight, SrbfPoint& point) const;
  void finish(SrbfPoint& point) const;
  /// f at a finished point, never negative. `wl`, like `wv`, is in the frame of the side.
  Rgb value(const SrbfPoint& point, const Vec3& wl) const;
  /// Data prepared for a light direction that many points share: none here.
  using Light = Vec3;
  Light light(uint32_t /*side*/, const Vec3& wl) const { return wl; }
  /// Normal of the visible relief, blended over the places of the point.
  Vec3 normal(const SrbfPoint& point) const { return glm::transpose(point.to_normal) * Vec3(0, 0, 1); }

 private:
  /// A texel is a record of bytes: its coefficients, those of lobes in the tile's frame first, each part padded; then
  /// the slope of the relief, x and y in sixteen bits each. A lobe appears once for each axis that uses it.
  struct Level {
    Vec2 texels() const { return {relief.width(), relief.height()}; }
    Vec2 seen_texel(const Vec2& place, const Vec3& wv) const { return relief.seen_texel(place, wv); }
    Relief relief;
    AlignedArray<uint8_t> record;  // [row][column][record]
  };
  struct Side {
    Side(const SrbfBtf& btf, const SrbfSide& side);
    void add_level(Relief relief, const SrbfLevel& from, const std::vector<uint32_t>& place);
    uint32_t slope() const { return stride - 4; }  // offset in a record

    MultivariateLobes tile, texel;
    uint32_t stride;                  // bytes per record
    AlignedArray<float> least, step;  // scale of each byte of a record
    AlignedArray<float> color;        // color of each byte's lobe, linear Rec. 709; see lobe_sums
    std::vector<Level> levels;
  };

  std::shared_ptr<const SrbfBtf> btf_;
  std::vector<Side> sides_;
};

/// f of every texel of the finest level for one pair of directions, [row][column][channel]; zero if the model has no
/// direction on that side of the plane.
void srbf_image(const SrbfEvaluator& evaluator, const DirectionPair& pair, std::vector<float>& rgb);

// Lookup of a view ray in a mip pyramid of reliefs.

/// The two mip levels of a lookup and the positions on them.
struct SeenLevels {
  size_t fine;         // the finer level; the other is the next
  float part;          // weight of the coarser level, in [0, 1)
  Vec2 texel, coarse;  // in texels from the center of the first one; `coarse` only if `part` is not 0
};

/// `levels`: finest first; each has texels(), the resolution along both axes, and seen_texel(place, wv)
/// (Relief::seen_texel). `uv`: in tiles, periodic. `level`: clamped to the available levels.
template <typename Levels>
SeenLevels seen_levels(const Levels& levels, const Vec2& uv, float level, const Vec3& wv) {
  const float place = std::clamp(level, 0.0f, static_cast<float>(levels.size() - 1));
  const auto fine = static_cast<size_t>(place);
  const Vec2 inside = std::isfinite(uv.x + uv.y) ? uv - glm::floor(uv) : Vec2(0.0f);
  SeenLevels seen{fine, place - static_cast<float>(fine), levels[fine].seen_texel(inside, wv), Vec2(0.0f)};
  if (seen.part == 0) return seen;
  // The finer relief is intersected once, for both levels.
  seen.coarse = (seen.texel + 0.5f) * (levels[fine + 1].texels() / levels[fine].texels()) - 0.5f;
  return seen;
}

}  // namespace velour
