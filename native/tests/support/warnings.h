// Finds warnings and their values.
#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/warning.h"

namespace velour {

/// How GoogleTest prints a warning.
inline void PrintTo(const Warning& warning, std::ostream* out) { *out << warnings_json({warning}).dump(); }

namespace test {

/// Null if there is none.
inline const Warning* find_warning(const std::vector<Warning>& warnings, WarningCode code) {
  const auto found = std::ranges::find(warnings, code, &Warning::code);
  return found == warnings.end() ? nullptr : &*found;
}

template <typename T>
T value_of(const Warning& warning, const std::string& name) {
  for (const auto& [key, value] : warning.values) {
    if (key == name) return std::get<T>(value);
  }
  throw std::out_of_range(name);
}

}  // namespace test
}  // namespace velour
