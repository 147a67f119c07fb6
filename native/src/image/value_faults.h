// Values that no light can have, and what takes their place.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace velour {

struct ValueFaults {
  size_t infinite = 0, no_number = 0, negative = 0;  // of the values that were looked at; no_number: NaN and -infinity
  float brightest = 65504;                           // of the finite ones, and at least the largest half float

  /// Infinity says "brighter than could be stored": nothing is brighter afterwards. What is no number becomes 0.
  float finite(float v) const { return std::isfinite(v) ? v : (v > 0 ? brightest : 0.0f); }
};

/// Looks at the first `used` of every `stride` values.
ValueFaults find_value_faults(std::span<const float> values, size_t stride = 1, size_t used = 1);

/// "SUBJECT: 12 values are infinite and count as 65504.", a sentence for each kind that there is.
std::vector<std::string> fault_sentences(const ValueFaults& faults, const std::string& subject);

}  // namespace velour
