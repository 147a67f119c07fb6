// What a test proves of files that other programs write: a line of docs/reference/inputs.md (scripts/inputs).
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace velour::test {

/// `verdict`: "read", "converted: ..." or "refused". Two tests may say the same of a variant.
inline void record_input(const std::string& format, const std::string& variant, const std::string& verdict) {
  ::testing::Test::RecordProperty("input|" + format + "|" + variant, verdict);
}

}  // namespace velour::test
