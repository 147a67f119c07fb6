// What comes before the first camera ray: checks, and what strategies make of the scene.
#pragma once

#include <tbb/task_arena.h>

#include <chrono>
#include <vector>

#include "render/tile_renderer.h"

namespace velour {

/// Throws Error(invalid_argument) where the crop holds no pixels, or others than the picture's.
void check_crop(const RenderOptions& options);

/// Throws Error(invalid_argument) unless `low` <= `value` <= `high`. `options` and `name` are for the message.
void require_range(const char* options, const char* name, int value, int low, int high);

/// `options`, with no larger a split than there are directions, and the end of samples in numbers. Throws
/// Error(invalid_argument) with the option at fault.
RenderOptions checked(RenderOptions options);

/// Camera rays per pixel of a full-size pass: a tile takes less than 10 ms, so that a cancel is seen soon.
inline constexpr int kMaxPass = 8;

/// What tables or fits before the first pass take of the whole, roughly.
inline constexpr double kPreparation = 0.05;

/// Does `work` as the stage `name` of `progress`, [begin, end] of the whole, and notes its seconds.
template <typename Work>
void run_stage(Progress& progress, std::vector<RenderStage>& stages, const char* name, double begin, double end,
               const Work& work) {
  progress.stage(name, begin, end);
  const auto start = std::chrono::steady_clock::now();
  work();
  stages.push_back({name, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()});
}

/// Makes what the strategy of `context` needs beside its lighting; throws Error(cancelled).
void prepare(RenderContext& context, tbb::task_arena& arena, Progress& progress, std::vector<RenderStage>& stages);

}  // namespace velour
