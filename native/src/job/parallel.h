// Independent pieces of work over threads.
#pragma once

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <atomic>
#include <cstddef>

#include "job/progress.h"
#include "job/threads.h"

namespace velour {

/// Calls `work()`, whose pieces on as many threads all share one arena: many small loops in turn find its threads
/// awake.
template <class Work>
void in_one_arena(int threads, const Work& work) {
  if (inside_arena_of(threads)) return work();
  oneapi::tbb::task_arena(arena_concurrency(threads)).execute(work);
}

/// Calls `work(i)` for i in [0, count) on the threads of the caller's arena. For tables that are made where they are
/// needed, which may be inside of another loop: all pieces are done or an exception comes out, even if the loop around
/// it is cancelled, and the waiting thread takes no task from outside, so that the caller may hold a lock.
template <class Work>
void parallel_fill(size_t count, const Work& work) {
  oneapi::tbb::task_group_context context(oneapi::tbb::task_group_context::isolated);
  oneapi::tbb::this_task_arena::isolate([&] { oneapi::tbb::parallel_for(size_t{0}, count, work, context); });
}

/// Calls `work(i)` for i in [0, count) on `threads` threads (0: all), and stops at a cancel. An exception of any piece
/// ends the others and comes out of here. Pieces may have pieces of their own: all share the same threads, and a thread
/// that waits for its own may do any other in the meantime, so a piece that has some must hold no lock.
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
  // With a context of its own: an error in a loop around this one would else end this one, without an exception in
  // here, and the caller would go on with pieces that were never done.
  oneapi::tbb::task_group_context context(oneapi::tbb::task_group_context::isolated);
  in_one_arena(threads,
               [&] { oneapi::tbb::parallel_for(size_t{0}, count, piece, oneapi::tbb::simple_partitioner(), context); });
}

/// Calls `work(i)` for i in [0, count) on `threads` threads (0: all), reports progress and stops at a cancel. An
/// exception of any piece ends the others and comes out of here. Pieces must not depend on one another: then the result
/// does not depend on the threads.
template <class Work>
void parallel_for_each(size_t count, int threads, Progress& progress, const Work& work) {
  std::atomic<size_t> done{0};
  parallel_pieces(count, threads, progress, [&](size_t i) {
    work(i);
    progress.update(static_cast<double>(++done) / static_cast<double>(count));
  });
}

}  // namespace velour
