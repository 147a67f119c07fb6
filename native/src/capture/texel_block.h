// Blocks of texels that are traced together, and how texels are sampled.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "btf/btf_measurement.h"

namespace velour {

/// Parameters that determine the values of every texel.
struct TexelSampling {
  uint32_t samples = 16;  // paths per texel and view
  uint32_t bounces = 1;   // further surfaces that a path meets after the first
  uint64_t seed = 0;
};

/// Texels [column, column + columns) x [row, row + rows).
struct TexelBlock {
  uint32_t column, row, columns, rows;
  uint32_t texels() const { return columns * rows; }
};

/// A grid divided into square blocks; the last of each row and column may be smaller. Their size depends on the
/// sampling alone, so that values do not depend on threads or memory.
class TexelBlocks {
 public:
  TexelBlocks(const TexelGrid& grid, const TexelSampling& sampling) : grid_(grid), side_(side(sampling)) {}

  uint32_t count() const { return columns() * rows(); }
  TexelBlock block(uint32_t number) const {
    const uint32_t column = number % columns() * side_, row = number / columns() * side_;
    return {column, row, std::min(side_, grid_.width - column), std::min(side_, grid_.height - row)};
  }

 private:
  /// Vertices per block, as measured: bounce rays profit from neighbors until the vertices no longer fit the caches.
  static constexpr double kVertices = 16384;
  static uint32_t side(const TexelSampling& s) {
    const double texels = kVertices / (static_cast<double>(s.samples) * (1.0 + s.bounces));
    return static_cast<uint32_t>(std::clamp(std::sqrt(texels), 1.0, 64.0));
  }
  uint32_t columns() const { return (grid_.width + side_ - 1) / side_; }
  uint32_t rows() const { return (grid_.height + side_ - 1) / side_; }

  TexelGrid grid_;
  uint32_t side_;
};

}  // namespace velour
