// An image for a viewer who keeps changing the scene: coarse at once, then finer, then less noisy.
#pragma once

#include <tbb/task_arena.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "render/film/film.h"
#include "render/tile_renderer.h"

namespace velour {

/// Renders levels that each halve the pixel size, one camera ray per pixel, then continues at full size. Camera rays,
/// strategies and light are those of render(): after all spp the image is the same, bit for bit. The time that the
/// previous image took determines how coarse an image begins. The strategy `automatic` is `mis` here, without a pilot.
class ProgressiveRender {
 public:
  struct Picture {
    int width = 0, height = 0;  // 0: there is no image yet
    uint32_t samples = 0;       // light directions per pixel of full size
    uint64_t version = 0;       // increases with every visible change
  };

  /// `scene` may change between runs; restart() must then be called before the next run. Of `options`, noise,
  /// time_limit, samples, crop and stop are ignored. With `denoise`, the image is denoised from the first full-size
  /// pass on, each time its camera rays have doubled, and only denoised images are shown from then on. Throws what
  /// render() throws for invalid options.
  ProgressiveRender(std::shared_ptr<Scene> scene, const RenderOptions& options);

  /// Makes the next run start from the beginning. Must not be called during a run.
  void restart();
  /// Commits the scene and renders until the image has all spp. After Error(cancelled), the next run continues where
  /// this one stopped.
  void run(Progress& progress);

  // From any thread, at any time:
  Picture picture() const;
  /// RGBA, premultiplied, row 0 at the bottom; pixels not yet rendered come from the previous level. Throws
  /// Error(invalid_argument) if `pixels` is smaller than the image; room for the full size always suffices.
  Picture read(std::span<float> pixels) const;

 private:
  struct Level {
    Level(int width, int height, const PassOptions& passes);
    Film film;
    std::vector<PixelRect> tiles;
    std::vector<int> done;  // camera rays per pixel, by tile
    int least = 0;          // minimum of `done`
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
  RenderOptions options_;  // options of the current level
  tbb::task_arena arena_;
  std::unique_ptr<RenderContext> context_;
  uint64_t prepared_for_ = 0;  // revision of the scene
  FirstLevel first_;
  std::vector<std::unique_ptr<Level>> levels_;  // null: not begun, since films are large
  int begin_;                                   // level at which the image began
  int level_;
  std::chrono::steady_clock::time_point start_;  // start of the first level
  bool is_unseen_ = true;

  mutable std::mutex mutex_;        // guards the members below
  const Level* shown_ = nullptr;    // null: nothing yet
  const Level* beneath_ = nullptr;  // previous level, where `shown_` has holes
  std::vector<float> denoised_;     // RGBA, full size: shown instead of `shown_`; empty: none
  uint32_t samples_ = 0;
  std::atomic<uint64_t> version_{0};
};

}  // namespace velour
