// Smooth noise that repeats.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

namespace velour {

/// Value noise: uniform random numbers in [0, 1) on the points of a lattice, joined with continuous slopes, never
/// outside of [0, 1). `cells` lattice cells along each axis, then it repeats.
struct PeriodicNoise {
  uint64_t seed = 0;
  uint64_t stream = 0;  // another noise of the same seed
  glm::ivec2 cells{1, 1};

  /// `at` in periods: at + (1, 0) and at + (0, 1) give the same.
  double operator()(const glm::dvec2& at) const;
};

}  // namespace velour
