#include "base/text_number.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace velour {
namespace {

/// Whether the magnitude of a number is at least 1, from the power of ten of its first digit.
bool is_at_least_one(std::string_view number) {
  const size_t exponent = std::min(number.find_first_of("eE"), number.size());
  const std::string_view digits = number.substr(0, exponent);
  const size_t first = digits.find_first_of("123456789"), point = std::min(digits.find('.'), digits.size());
  if (first == std::string_view::npos) return false;
  const double digits_before_point = static_cast<double>(point) - static_cast<double>(first);
  const auto power = leading_number(number.substr(std::min(exponent + 1, number.size())));
  return digits_before_point + (power ? power->value : 0) > 0;
}

}  // namespace

std::optional<LeadingNumber> leading_number(std::string_view text) {
  const size_t plus = text.starts_with('+') ? 1 : 0;
  const std::string_view unsigned_text = text.substr(plus);
  if (plus == 1 && unsigned_text.starts_with('-')) return std::nullopt;
  double value = 0;
  const auto [stop, error] = std::from_chars(unsigned_text.data(), unsigned_text.data() + unsigned_text.size(), value);
  if (error == std::errc::invalid_argument) return std::nullopt;
  const auto length = static_cast<size_t>(stop - unsigned_text.data());
  if (error == std::errc::result_out_of_range) {
    const double size = is_at_least_one(unsigned_text.substr(0, length)) ? std::numeric_limits<double>::infinity() : 0;
    value = std::copysign(size, unsigned_text.starts_with('-') ? -1.0 : 1.0);
  }
  return LeadingNumber{value, plus + length};
}

std::optional<double> number_from(std::string_view text) {
  const auto number = leading_number(text);
  return number && number->length == text.size() ? std::optional(number->value) : std::nullopt;
}

}  // namespace velour
