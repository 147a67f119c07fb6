// Numbers in text files of other programs, independent of the locale.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace velour {

struct LeadingNumber {
  double value;
  size_t length;  // of its text
};

/// The decimal number at the beginning of `text`, with or without sign (+0.17) and exponent; also inf and nan. A number
/// too large for a double is infinity, one too small 0. Empty if there is no number.
std::optional<LeadingNumber> leading_number(std::string_view text);

/// The number that `text` consists of; empty if there is anything else in it.
std::optional<double> number_from(std::string_view text);

}  // namespace velour
