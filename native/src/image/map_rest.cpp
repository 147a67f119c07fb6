#include "image/map_rest.h"

#include <algorithm>

namespace velour {
namespace {

/// Predicts byte `x` of `row`. `below`: the row below, or null.
uint8_t guess(const uint8_t* row, const uint8_t* below, uint64_t x) {
  if (x == 0) return below ? below[0] : 0;
  if (!below) return row[x - 1];
  const int left = row[x - 1], under = below[x], corner = below[x - 1];
  return static_cast<uint8_t>(std::clamp(left + under - corner, std::min(left, under), std::max(left, under)));
}

}  // namespace

void maps_to_rests(std::span<uint8_t> maps, uint64_t rows, uint64_t columns) {
  // Runs from the last byte to the first, so that predictions use bytes, not residuals.
  for (uint64_t line = maps.size() / columns; line-- > 0;) {
    uint8_t* const row = maps.data() + line * columns;
    const uint8_t* const below = line % rows == 0 ? nullptr : row - columns;
    for (uint64_t x = columns; x-- > 0;) row[x] = static_cast<uint8_t>(row[x] - guess(row, below, x));
  }
}

void rests_to_maps(std::span<uint8_t> rests, uint64_t rows, uint64_t columns) {
  for (uint64_t line = 0; line < rests.size() / columns; ++line) {
    uint8_t* const row = rests.data() + line * columns;
    const uint8_t* const below = line % rows == 0 ? nullptr : row - columns;
    for (uint64_t x = 0; x < columns; ++x) row[x] = static_cast<uint8_t>(row[x] + guess(row, below, x));
  }
}

}  // namespace velour
