// Choosing one of several by a random number, and keeping what is left of the number.
#pragma once

#include <algorithm>

namespace velour {

/// Index i with cdf[i - 1] <= u < cdf[i] among `n` >= 1 running sums, the last of which is 1. `u` in [0, 1) becomes its
/// place between the two, again in [0, 1). In double: each choice stretches the steps of a 24-bit number by the inverse
/// of the probability. Bisection without a branch to predict.
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

/// The middle of a 24-bit number's step. What choices leave of it is never 0, which for a lobe would be the antipode.
inline double middle_of_step(float u) { return u + 0x1p-25; }

}  // namespace velour
