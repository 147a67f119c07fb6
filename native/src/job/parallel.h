// Independent pieces of work over threads.
#pragma once

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <atomic>
#include <cstddef>

#include "job/progress.h"
#include "job/threads.h"

namespace velour {

/// Calls `work(i)` for i in [0, count) on `threads` threads (0: all), and stops at a cancel. An exception of any piece
/// ends the others and comes out of here.
template <class Work>
void parallel_pieces(size_t count, int threads, const Progress& progress, const Work& work) {
  oneapi::tbb::task_arena arena(arena_concurrency(threads));
  arena.execute([&] {
    const auto piece = [&](size_t i) {
      progress.check();
      work(i);
    };
    oneapi::tbb::parallel_for(size_t{0}, count, piece, oneapi::tbb::simple_partitioner());
  });
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
