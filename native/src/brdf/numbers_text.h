// Reads numbers separated by commas or white space from a text.
#pragma once

#include <charconv>
#include <limits>
#include <optional>
#include <string_view>

namespace velour {

inline void skip_separators(std::string_view& rest) {
  const size_t next = rest.find_first_not_of(", \t\n\v\f\r");
  rest.remove_prefix(next == std::string_view::npos ? rest.size() : next);
}

/// Removes the next number from `rest`. A number too small for a float becomes 0, one too large infinity. Nothing if no
/// number follows.
inline std::optional<float> next_number(std::string_view& rest) {
  skip_separators(rest);
  double value = 0;
  const auto [stop, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  const auto length = static_cast<size_t>(stop - rest.data());
  if (length == 0) return std::nullopt;
  if (error != std::errc()) {
    const bool is_tiny = rest.substr(0, length).find("e-") != std::string_view::npos ||
                         rest.substr(0, length).find("E-") != std::string_view::npos;
    value = is_tiny ? 0 : std::numeric_limits<double>::infinity();
  }
  rest.remove_prefix(length);
  return static_cast<float>(value);
}

}  // namespace velour
