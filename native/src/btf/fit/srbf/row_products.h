// Products of a small matrix, row by row, with three vectors: the inner loop of a texel's solve.
#pragma once

#include <cstdint>

namespace velour {

/// `rows`: [count][stride], stride a multiple of 16, aligned to 64 bytes, as are all arrays here.
/// value[3 i + a] = row i . coefficient[a], where coefficient is [3][stride].
void rows_times(const float* rows, uint32_t count, uint32_t stride, const float* coefficient, float* value);

/// sum[a][k] = sum over i of rows[i][k] value[3 i + a].
void times_rows(const float* rows, uint32_t count, uint32_t stride, const float* value, float* sum);

}  // namespace velour
