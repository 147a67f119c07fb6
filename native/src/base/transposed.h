// Matrix transposition.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace velour {

/// Converts [row][column] to [column][row], a few columns at a time so that the writes stay in the cache.
inline std::vector<float> transposed(const std::vector<float>& matrix, uint64_t columns) {
  constexpr uint64_t kColumnsAtOnce = 16;
  const uint64_t rows = matrix.size() / columns;
  std::vector<float> result(matrix.size());
  for (uint64_t first = 0; first < columns; first += kColumnsAtOnce) {
    const uint64_t end = std::min(columns, first + kColumnsAtOnce);
    for (uint64_t row = 0; row < rows; ++row) {
      for (uint64_t k = first; k < end; ++k) result[k * rows + row] = matrix[row * columns + k];
    }
  }
  return result;
}

}  // namespace velour
