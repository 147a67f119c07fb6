// Work before the first camera ray: checks, and what strategies derive from the scene.
#pragma once

#include <tbb/task_arena.h>

#include <chrono>
#include <vector>

#include "render/tile_renderer.h"

namespace velour {

/// Throws Error(invalid_argument) if the crop is empty or exceeds the image.
void check_crop(const RenderOptions& options);

/// Throws Error(invalid_argument) unless `low` <= `value` <= `high`. `options` and `name` are for the message.
void require_range(const char* options, const char* name, int value, int low, int high);

/// Returns `options` with `split` limited to the number of directions and the end of samples resolved. Throws
/// Error(invalid_argument) naming the option at fault.
RenderOptions checked(RenderOptions options);

/// Camera rays per pixel of a full-size pass: a tile takes less than 10 ms, so that cancellation takes effect soon.
inline constexpr int kMaxPass = 8;

/// Approximate share of the whole that tables or fits before the first pass take.
inline constexpr double kPreparation = 0.05;

/// Runs `work` as stage `name` of `progress`, [begin, end] of the whole, and records its seconds.
template <typename Work>
void run_stage(Progress& progress, std::vector<RenderStage>& stages, const char* name, double begin, double end,
               const Work& work) {
  progress.stage(name, begin, end);
  const auto start = std::chrono::steady_clock::now();
  work();
  stages.push_back({name, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()});
}

/// Creates what the strategy of `context` needs beside its lighting. Throws Error(cancelled).
void prepare(RenderContext& context, tbb::task_arena& arena, Progress& progress, std::vector<RenderStage>& stages);
/// Creates what products need: RenderContext::sky. Throws Error(cancelled).
void prepare_products(RenderContext& context, tbb::task_arena& arena, Progress& progress,
                      std::vector<RenderStage>& stages);

}  // namespace velour
