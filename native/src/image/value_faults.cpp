#include "image/value_faults.h"

#include <algorithm>
#include <cstdio>

namespace velour {

ValueFaults find_value_faults(std::span<const float> values, size_t stride, size_t used) {
  ValueFaults faults;
  for (size_t first = 0; first + used <= values.size(); first += stride) {
    for (const float v : values.subspan(first, used)) {
      if (std::isfinite(v)) {
        faults.negative += v < 0;
        faults.brightest = std::max(faults.brightest, v);
      } else {
        ++(v > 0 ? faults.infinite : faults.no_number);
      }
    }
  }
  return faults;
}

std::vector<std::string> fault_sentences(const ValueFaults& faults, const std::string& subject) {
  std::vector<std::string> sentences;
  const auto add = [&](size_t count, const char* one, const char* many, const char* instead) {
    if (count == 0) return;
    sentences.push_back(subject + ": " + std::to_string(count) + (count == 1 ? one : many) + instead + ".");
  };
  char brightest[32];
  std::snprintf(brightest, sizeof brightest, "%.6g", static_cast<double>(faults.brightest));
  add(faults.infinite, " value is infinite and was replaced by ", " values are infinite and were replaced by ",
      brightest);
  add(faults.no_number, " value is not a number (NaN) and was replaced by ",
      " values are not numbers (NaN) and were replaced by ", "0");
  add(faults.negative, " value is negative and was replaced by ", " values are negative and were replaced by ", "0");
  return sentences;
}

}  // namespace velour
