#include "render/progressive.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <string>

#include "job/threads.h"
#include "render/noise_target.h"
#include "render/preparation.h"

namespace velour {
namespace {

/// Pixels of the coarsest level at most: a fraction of 0.2 s on one thread.
constexpr int kFirstPixels = 16000;
/// Light directions a pixel of the coarse levels: they are looked at for a moment only.
constexpr int kCoarseDirections = 4;
/// Camera rays a pixel of a pass at most.
constexpr int kLargestPass = 8;

int part(int side, int divisor) { return (side + divisor - 1) / divisor; }

int first_divisor(int width, int height) {
  int divisor = 1;
  while (part(width, divisor) * part(height, divisor) > kFirstPixels) divisor *= 2;
  return divisor;
}

}  // namespace

ProgressiveRender::Level::Level(int width, int height)
    : film(width, height), tiles(blocks_of(film.window())), done(tiles.size()) {}

ProgressiveRender::ProgressiveRender(std::shared_ptr<Scene> scene, const RenderOptions& options)
    : scene_(std::move(scene)),
      asked_(checked(options)),
      arena_(arena_concurrency(options.threads)),
      first_divisor_(first_divisor(asked_.width, asked_.height)) {}

void ProgressiveRender::restart() {
  for (auto& level : levels_) {
    std::ranges::fill(level->done, 0);
    level->least = 0;
  }
  level_ = 0;
  const std::lock_guard lock(mutex_);
  shown_ = beneath_ = nullptr;
  samples_ = 0;
}

void ProgressiveRender::run(Progress& progress) {
  prepare_scene(progress);
  progress.stage("render", 0.0, 1.0);
  while (true) {
    render_level(progress);
    if (is_last()) return;
    ++level_;
  }
}

/// Its hierarchy, lights, and what the strategy needs: kept while the camera alone moves.
void ProgressiveRender::prepare_scene(Progress& progress) {
  progress.stage("hierarchy", 0.0, 0.0);
  scene_->commit(asked_.threads);
  progress.check();
  if (context_ && prepared_for_ == scene_->revision()) return;
  context_.reset();
  options_ = asked_;
  auto context = std::make_unique<RenderContext>(*scene_, options_, progress);
  std::vector<RenderStage> unreported;
  prepare(*context, arena_, progress, unreported);
  context_ = std::move(context);
  prepared_for_ = scene_->revision();
}

void ProgressiveRender::set_options(const Level& level) {
  options_ = asked_;
  options_.noise = 0;
  options_.width = level.film.width();
  options_.height = level.film.height();
  if (!is_last()) options_.spp = options_.split = std::min(asked_.split, kCoarseDirections);
}

void ProgressiveRender::render_level(Progress& progress) {
  if (level_ == levels_.size()) {
    levels_.push_back(std::make_unique<Level>(part(asked_.width, divisor()), part(asked_.height, divisor())));
  }
  Level& level = *levels_[level_];
  set_options(level);
  if (level.least == 0 && std::ranges::all_of(level.done, [](int n) { return n == 0; })) level.film.clear();
  const int total = context_->camera_rays();
  while (level.least < total) {
    const int target = std::min(level.least + std::clamp(level.least, 1, kLargestPass), total);
    render_pass(level, target, progress);
    level.least = target;
    show();
    if (is_last()) progress.update(static_cast<double>(target) / total);
  }
}

void ProgressiveRender::render_pass(Level& level, int target, Progress& progress) {
  tbb::enumerable_thread_specific<TileRenderer> renderers([this] { return TileRenderer(*context_); });
  arena_.execute([&] {
    tbb::parallel_for(size_t{0}, level.tiles.size(), [&](size_t t) {
      int& done = level.done[t];
      if (done >= target) return;  // before a cancel
      renderers.local().render(level.tiles[t], done, target - done, level.film, nullptr, progress);
      done = target;
      if (level_ > 0) show();
    });
  });
}

/// Of the first level nothing but the whole: there is nothing beneath it.
void ProgressiveRender::show() {
  const std::lock_guard lock(mutex_);
  shown_ = levels_[level_].get();
  beneath_ = shown_->least == 0 && level_ > 0 ? levels_[level_ - 1].get() : nullptr;
  samples_ = is_last() ? static_cast<uint32_t>(std::min(shown_->least * asked_.split, asked_.spp)) : 0;
  ++version_;
}

ProgressiveRender::Picture ProgressiveRender::picture() const {
  const std::lock_guard lock(mutex_);
  if (shown_ == nullptr) return {0, 0, 0, version_};
  return {shown_->film.width(), shown_->film.height(), samples_, version_};
}

ProgressiveRender::Picture ProgressiveRender::read(std::span<float> pixels) const {
  const std::lock_guard lock(mutex_);
  if (shown_ == nullptr) return {0, 0, 0, version_};
  const Film& film = shown_->film;
  const size_t count = 4 * static_cast<size_t>(film.width()) * static_cast<size_t>(film.height());
  if (pixels.size() < count) {
    throw Error(Status::invalid_argument, "The picture has " + std::to_string(count) + " values, more than the " +
                                              std::to_string(pixels.size()) + " that there is room for.");
  }
  film.read_over(beneath_ != nullptr ? &beneath_->film : nullptr, pixels.first(count));
  return {film.width(), film.height(), samples_, version_};
}

}  // namespace velour
