// Validity of the entries of a measurement.
#pragma once

#include <algorithm>
#include <cmath>

#include "brdf/measure/measurement.h"

namespace velour {

/// When a finite entry counts as negative: MERL marks invalid entries by a negative value in any channel. Elsewhere a
/// channel may be negative because the color is outside Rec. 709, and only a negative luminance is invalid.
enum class NegativeRule { any_channel, luminance };

/// Values beyond this count as not finite: sums over them would overflow.
inline constexpr float kLargestEntry = 1e30f;

/// Counts an entry above the horizon and returns whether it is valid.
inline bool count_entry(const Rgb& f, NegativeRule rule, EntryCounts& counts) {
  ++counts.total;
  const bool finite = std::abs(f.r) < kLargestEntry && std::abs(f.g) < kLargestEntry && std::abs(f.b) < kLargestEntry;
  if (!finite) return ++counts.not_finite, false;
  const bool negative_channel = std::min({f.r, f.g, f.b}) < 0.0f;
  if (rule == NegativeRule::any_channel ? negative_channel : luminance(f) < 0.0f) return ++counts.negative, false;
  ++counts.valid;
  if (negative_channel) ++counts.out_of_gamut;
  return true;
}

inline void count_below_horizon(EntryCounts& counts) {
  ++counts.total;
  ++counts.below_horizon;
}

}  // namespace velour
