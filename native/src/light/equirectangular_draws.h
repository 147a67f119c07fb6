// Run-time dispatched SIMD kernels of EquirectangularImage::sample.
#pragma once

#include <cstdint>

#include "math/sphere/directions.h"

namespace velour {

/// Marginal density of the rows. Cell i of the cdf, a band, lies between the centers of rows i - 1 and i; the first and
/// the last band end at a pole.
struct MarginalTable {
  int height;
  const float* cdf;      // [height + 2]
  const int32_t* guide;  // [height + 1]
  const float* node;     // [height + 2], mean node of row i - 1; 0 at both ends
};

/// Samples in progress.
struct alignas(64) EquirectangularDraws {
  static constexpr int kCapacity = DirectionBatch::kCapacity;
  float u[kCapacity], v[kCapacity];  // random numbers in [0, 1), then the point as fractions of the image's sides
  int32_t row[kCapacity];            // row from whose density the column is sampled
  // The column's cell in that row: its index, the cdf at both ends, the density's nodes at both ends.
  float cell[kCapacity], low[kCapacity], high[kCapacity], left[kCapacity], right[kCapacity];
};

/// Samples `row` and replaces v by the point's v.
void draw_rows(const MarginalTable& table, EquirectangularDraws& draws, int count);
/// Replaces u by the point's u, sampled within the cell.
void draw_columns(int width, EquirectangularDraws& draws, int count);

}  // namespace velour
