// Which tests run: the short suite, or all of them.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>

namespace velour::test {

/// Whether long tests are asked for too: $VELOUR_LONG_TESTS, which `scripts/test --all` sets.
inline bool long_tests() { return std::getenv("VELOUR_LONG_TESTS") != nullptr; }

}  // namespace velour::test

/// Leaves a test to `scripts/test --all`.
#define VELOUR_LONG_TEST() \
  if (!::velour::test::long_tests()) GTEST_SKIP() << "long: scripts/test --all runs it"
