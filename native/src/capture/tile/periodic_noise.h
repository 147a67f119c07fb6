// Random values and smooth noise that repeat with the cell of a tile.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace velour {

/// Value noise: uniform random numbers in [0, 1) at the points of a lattice, interpolated with continuous slopes, never
/// outside [0, 1). Repeats after `cells` lattice cells along each axis.
struct PeriodicNoise {
  uint64_t seed = 0;
  uint64_t stream = 0;  // selects independent noise for the same seed
  glm::ivec2 cells{1, 1};

  /// `at` in periods: at + (1, 0) and at + (0, 1) give the same value.
  double operator()(const glm::dvec2& at) const;
};

}  // namespace velour
