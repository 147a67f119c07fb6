#pragma once

#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace velour {

/// Concurrency of a task arena for `threads` threads (0: all). Never more than the machine's: Embree lowers TBB's
/// global limit to that when it opens, and TBB then prints a warning for every arena that asks for more.
inline int arena_concurrency(int threads) {
  return threads > 0 ? std::min(threads, tbb::info::default_concurrency()) : tbb::task_arena::automatic;
}

}  // namespace velour
