// A picture for somebody who watches it and keeps changing the scene: coarse at once, then finer, then less noisy.
#pragma once

#include <tbb/task_arena.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "render/first_level.h"
#include "render/tile_renderer.h"

namespace velour {

/// Goes through levels of half the pixels' size each, one camera ray a pixel, and then on at full size. Camera rays,
/// strategies and light are those of render(): after all of spp its picture is the same, bit for bit. How coarse it
/// begins is what the picture before took.
class ProgressiveRender {
 public:
  struct Picture {
    int width = 0, height = 0;  // 0: there is none yet
    uint32_t samples = 0;       // light directions that every pixel of full size has
    uint64_t version = 0;       // grows with what there is to see
  };

  /// `scene` may change between runs: then restart() goes before the next one. Of `options`, noise, time_limit,
  /// samples, crop and stop are not used. With `denoise` the picture is denoised from the first pass of full size on,
  /// each time that it has twice the camera rays, and what is shown has no noise from then on. Throws what render()
  /// throws of options.
  ProgressiveRender(std::shared_ptr<Scene> scene, const RenderOptions& options);

  /// The next run begins anew. Not while one runs.
  void restart();
  /// Commits the scene, and renders until the picture has all of spp, or Error(cancelled); then the next run goes on
  /// where this one was.
  void run(Progress& progress);

  // From any thread, at any time:
  Picture picture() const;
  /// RGBA, premultiplied, row 0 at the bottom; pixels that are not there yet are those of the level before. Throws
  /// Error(invalid_argument) where `pixels` holds less than the picture has; a picture of full size always fits.
  Picture read(std::span<float> pixels) const;

 private:
  struct Level {
    Level(int width, int height, const PassOptions& passes);
    Film film;
    std::vector<PixelRect> tiles;
    std::vector<int> done;  // camera rays a pixel, by tile
    int least = 0;          // of them
  };
  bool is_last() const { return level_ == first_.last(); }
  void prepare_scene(Progress& progress);
  void set_options(const Level& level);
  void render_level(Progress& progress);
  void render_pass(Level& level, int target, Progress& progress);
  void show(std::vector<float> denoised = {});
  std::vector<float> denoised(const Film& film, const Progress& progress) const;
  void measure_first(bool is_whole);

  const std::shared_ptr<Scene> scene_;
  const RenderOptions asked_;
  RenderOptions options_;  // of the level
  tbb::task_arena arena_;
  std::unique_ptr<RenderContext> context_;
  uint64_t prepared_for_ = 0;  // revision of the scene
  FirstLevel first_;
  std::vector<std::unique_ptr<Level>> levels_;  // null: not begun, for films are large
  int begin_;                                   // the level that the picture began at
  int level_;
  std::chrono::steady_clock::time_point start_;  // of the first level
  bool is_unseen_ = true;

  mutable std::mutex mutex_;        // of what follows
  const Level* shown_ = nullptr;    // null: nothing yet
  const Level* beneath_ = nullptr;  // the level before, where `shown_` has holes
  std::vector<float> denoised_;     // RGBA, of full size: shown in the place of `shown_`; empty: nothing
  uint32_t samples_ = 0;
  std::atomic<uint64_t> version_{0};
};

}  // namespace velour
