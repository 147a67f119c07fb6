// Number of threads of a task.
#pragma once

#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace velour {

/// Concurrency of a task arena for `threads` threads (0: all), at most the machine's: more gain nothing, and Embree
/// lowers TBB's global limit to that number when it opens, after which TBB warns about every wider arena.
inline int arena_concurrency(int threads) {
  return threads > 0 ? std::min(threads, tbb::info::default_concurrency()) : tbb::task_arena::automatic;
}

/// Whether the calling thread already runs in an arena of this concurrency. Its work can then be shared there, and
/// small loops need no arena of their own.
inline bool inside_arena_of(int threads) {
  const int wanted = threads > 0 ? arena_concurrency(threads) : tbb::info::default_concurrency();
  return tbb::this_task_arena::current_thread_index() != tbb::task_arena::not_initialized &&
         tbb::this_task_arena::max_concurrency() == wanted;
}

}  // namespace velour
