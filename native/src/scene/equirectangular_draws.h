// Draws of an environment's image in flight: kernels of EquirectangularImage::sample, run-time dispatched SIMD.
#pragma once

#include <cstdint>

#include "sphere/direction_batch.h"

namespace velour {

/// The density of rows: cell i of the cdf, a band, lies between the centres of rows i - 1 and i, the first and the last
/// end at a pole.
struct MarginalTable {
  int height;
  const float* cdf;      // [height + 2]
  const int32_t* guide;  // [height + 1]
  const float* node;     // [height + 2], mean node of row i - 1; 0 at both ends
};

struct alignas(64) EquirectangularDraws {
  static constexpr int kCapacity = DirectionBatch::kCapacity;
  float u[kCapacity], v[kCapacity];  // numbers in [0, 1), in the end the place as shares of the image's sides
  int32_t row[kCapacity];            // whose density u draws the column from
  // Of the column's cell in that row: its number, the cdf at both ends, the density's nodes at both ends.
  float cell[kCapacity], low[kCapacity], high[kCapacity], left[kCapacity], right[kCapacity];
};

/// From v to `row` and the place v.
void draw_rows(const MarginalTable& table, EquirectangularDraws& draws, int count);
/// From u and the cell's numbers to the place u.
void draw_columns(int width, EquirectangularDraws& draws, int count);

}  // namespace velour
