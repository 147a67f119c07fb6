// Values that are invalid for light, and their replacements.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace velour {

struct ValueFaults {
  size_t infinite = 0, no_number = 0, negative = 0;  // numbers of such values; no_number: NaN and -infinity
  float brightest = 65504;                           // largest finite value, at least the largest half float

  /// Infinity means "brighter than could be stored" and becomes the brightest value; NaN and -infinity become 0.
  float finite(float v) const { return std::isfinite(v) ? v : (v > 0 ? brightest : 0.0f); }
};

/// Examines the first `used` of every `stride` values.
ValueFaults find_value_faults(std::span<const float> values, size_t stride = 1, size_t used = 1);

/// "SUBJECT: 12 values are infinite and count as 65504.", one sentence for each kind that occurs.
std::vector<std::string> fault_sentences(const ValueFaults& faults, const std::string& subject);

}  // namespace velour
