// What becomes of an entry of a measurement.
#pragma once

#include <algorithm>
#include <cmath>

#include "brdf/measurement.h"

namespace velour {

/// When a finite entry counts as negative: MERL marks its invalid entries by a negative value in any channel; elsewhere
/// a channel may be negative because the colour is outside Rec. 709, and only a negative luminance is no measurement.
enum class NegativeRule { any_channel, luminance };

/// Counts an entry above the horizon and says whether it is valid.
inline bool count_entry(const Rgb& f, NegativeRule rule, EntryCounts& counts) {
  ++counts.total;
  if (!std::isfinite(f.r) || !std::isfinite(f.g) || !std::isfinite(f.b)) return ++counts.not_finite, false;
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
