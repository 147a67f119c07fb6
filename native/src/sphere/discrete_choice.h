// Discrete sampling with a random number that is remapped for reuse.
#pragma once

#include <algorithm>

namespace velour {

/// Returns the index i with cdf[i - 1] <= u < cdf[i] of `n` >= 1 running sums, the last of which is 1. Remaps `u` in
/// [0, 1) to its relative position between the two, again in [0, 1). `u` is a double because each choice widens the
/// steps of a 24-bit number by the inverse of the probability. Branchless bisection.
inline int choose_index(const float* cdf, int n, double& u) {
  int first = 0;
  while (n > 1) {
    const int half = n / 2;
    first = cdf[first + half - 1] <= u ? first + half : first;
    n -= half;
  }
  const double below = first > 0 ? cdf[first - 1] : 0.0;
  u = std::clamp((u - below) / (cdf[first] - below), 0.0, 1 - 0x1p-53);
  return first;
}

/// Moves a 24-bit number to the middle of its step, so choices never remap it to 0, which is the antipode of a lobe.
inline double middle_of_step(float u) { return u + 0x1p-25; }

}  // namespace velour
