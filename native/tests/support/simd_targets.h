// Kernels that are chosen at run time must be right on every instruction set, not on the best one alone.
#pragma once

#include <gtest/gtest.h>

#include "base/simd.h"

namespace velour::test {

/// Calls `check` with dispatch pinned to each instruction set of this processor and build in turn.
template <class Check>
void on_every_simd_target(const Check& check) {
  for (const std::string& target : simd_targets()) {
    ASSERT_TRUE(select_simd_target(target.c_str()));
    SCOPED_TRACE(target);
    check();
  }
  select_simd_target("auto");
}

}  // namespace velour::test
