// What BtfDraws asks of a BTF, tabulated.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "material/btf_draws.h"

namespace velour {

/// f cos of a side of a BTF under the broad lights that BtfDraws asks for, over cells of the tile, their pyramid, and
/// views. Asking the BTF itself takes seven evaluations of it a point, where a path takes few lights from each: two
/// fifths of a render's time, for a variance that is 2 to 4 % less. The mirror direction is not tabulated: highlights
/// are too narrow for cells, and what misses one is a firefly. Memory: at most 0.6 MB. Immutable; thread-safe.
class BtfLookTable {
 public:
  using Broad = std::array<float, BtfLook::kBroad>;
  /// BtfLook::broad at a place, at a level of the BTF's pyramid, seen from `wv`. Called by several threads at once.
  using Ask = std::function<Broad(const Vec2& uv, float level, const Vec3& wv)>;

  /// Holds nothing.
  BtfLookTable() = default;
  /// `texels`: of the BTF, along both axes of the tile.
  BtfLookTable(const Vec2& texels, const Ask& ask);

  /// At the nearest cell, within 4 %. `level`: of the footprint.
  Broad look_up(const Vec2& uv, float level, const Vec3& wv) const;

 private:
  using Strengths = std::array<uint8_t, BtfLook::kBroad>;  // logarithms

  size_t first_of(uint32_t level) const;

  uint32_t cells_ = 0;                // along both axes of the tile, of the finest level; a power of 2
  float finest_ = 0;                  // level of the BTF's pyramid whose texels are as large as those
  std::vector<Strengths> strengths_;  // [level][row][column][view]
};

}  // namespace velour
