// Table of the BTF values that BtfDraws needs.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "material/btf_draws.h"

namespace velour {

/// f cos of one side of a BTF in the broad light directions of BtfDraws, over a pyramid of cells of the tile and over
/// views. Without it each point costs seven BTF evaluations although a path samples few lights there: two fifths of the
/// render time for 2 to 4 % less variance. The mirror direction is not tabulated: highlights are narrower than cells,
/// and missing one causes a firefly. Memory: at most 0.6 MB. Immutable; thread-safe.
class BtfLookTable {
 public:
  using Broad = std::array<float, BtfLook::kBroad>;
  /// Evaluates BtfLook::broad at `uv` on a level of the BTF's pyramid, seen from `wv`. Called concurrently.
  using Ask = std::function<Broad(const Vec2& uv, float level, const Vec3& wv)>;

  /// An empty table.
  BtfLookTable() = default;
  /// `texels`: resolution of the BTF along both axes of the tile.
  BtfLookTable(const Vec2& texels, const Ask& ask);

  /// Value of the nearest cell, quantized to within 4 %. `level`: mip level of the footprint.
  Broad look_up(const Vec2& uv, float level, const Vec3& wv) const;

 private:
  using Strengths = std::array<uint8_t, BtfLook::kBroad>;  // logarithmic

  size_t first_of(uint32_t level) const;

  uint32_t cells_ = 0;                // per axis of the tile, at the finest level; a power of 2
  float finest_ = 0;                  // level of the BTF's pyramid whose texels are as large as these cells
  std::vector<Strengths> strengths_;  // [level][row][column][view]
};

}  // namespace velour
