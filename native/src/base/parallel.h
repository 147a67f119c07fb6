// Parallel loops over independent pieces of work.
#pragma once

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>
#include <algorithm>
#include <atomic>
#include <cstddef>
#include "base/progress.h"

namespace velour {

// Number of threads of a task.

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

/// Calls `work()` in an arena shared by all parallel loops inside it that use the same number of threads, so that a
/// sequence of small loops finds its threads awake.
template <class Work>
void in_one_arena(int threads, const Work& work) {
  if (inside_arena_of(threads)) return work();
  oneapi::tbb::task_arena(arena_concurrency(threads)).execute(work);
}

/// Calls `work(i)` for i in [0, count) on the threads of the caller's arena. Meant for tables built on demand, possibly
/// inside another loop: either all pieces are done or an exception is thrown, even if the surrounding loop is
/// cancelled, and the waiting thread takes no outside task, so the caller may hold a lock.
template <class Work>
void parallel_fill(size_t count, const Work& work) {
  oneapi::tbb::task_group_context context(oneapi::tbb::task_group_context::isolated);
  oneapi::tbb::this_task_arena::isolate([&] { oneapi::tbb::parallel_for(size_t{0}, count, work, context); });
}

/// Calls `work(i)` for i in [0, count) on `threads` threads (0: all) and stops on cancellation. An exception in any
/// piece ends the others and is rethrown. Pieces may run nested loops: all share the same threads, and a thread waiting
/// for its own pieces may run any other piece meanwhile, so a piece with a nested loop must not hold a lock.
template <class Work>
void parallel_pieces(size_t count, int threads, const Progress& progress, const Work& work) {
  const auto piece = [&](size_t i) {
    progress.check();
    work(i);
  };
  if (count == 1 || arena_concurrency(threads) == 1) {
    for (size_t i = 0; i < count; ++i) piece(i);
    return;
  }
  // Uses an isolated context. Otherwise an error in a surrounding loop would end this one without an exception here,
  // and the caller would continue with pieces that were never done.
  oneapi::tbb::task_group_context context(oneapi::tbb::task_group_context::isolated);
  in_one_arena(threads,
               [&] { oneapi::tbb::parallel_for(size_t{0}, count, piece, oneapi::tbb::simple_partitioner(), context); });
}

/// Like parallel_pieces(), and reports progress. The pieces must be independent; then the result does not depend on the
/// number of threads.
template <class Work>
void parallel_for_each(size_t count, int threads, Progress& progress, const Work& work) {
  std::atomic<size_t> done{0};
  parallel_pieces(count, threads, progress, [&](size_t i) {
    work(i);
    progress.update(static_cast<double>(++done) / static_cast<double>(count));
  });
}

}  // namespace velour
