// How many threads a task takes.
#pragma once

#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace velour {

/// Concurrency of a task arena for `threads` threads (0: all). Never more than the machine's: more gain nothing, and
/// Embree lowers TBB's global limit to that when it opens, after which TBB prints a warning for every wider arena.
inline int arena_concurrency(int threads) {
  return threads > 0 ? std::min(threads, tbb::info::default_concurrency()) : tbb::task_arena::automatic;
}

/// Whether this thread is at work in an arena for so many: then its work may be shared out there, and no arena within
/// it is made for each small loop.
inline bool inside_arena_of(int threads) {
  const int wanted = threads > 0 ? arena_concurrency(threads) : tbb::info::default_concurrency();
  return tbb::this_task_arena::current_thread_index() != tbb::task_arena::not_initialized &&
         tbb::this_task_arena::max_concurrency() == wanted;
}

}  // namespace velour
