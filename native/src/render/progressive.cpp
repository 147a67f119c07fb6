#include "render/progressive.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <string>

#include "base/parallel.h"
#include "render/film/noise_target.h"
#include "render/preparation.h"

namespace velour {
namespace {

/// Light directions per pixel of the coarse levels, which are visible only for a moment.
constexpr int kCoarseDirections = 4;

}  // namespace

ProgressiveRender::Level::Level(int width, int height, const PassOptions& passes)
    : film({0, 0, width, height}, passes), tiles(blocks_of(film.window())), done(tiles.size()) {}

ProgressiveRender::ProgressiveRender(std::shared_ptr<Scene> scene, const RenderOptions& options)
    : scene_(std::move(scene)),
      asked_(checked(options)),
      arena_(arena_concurrency(options.threads)),
      first_(asked_.width, asked_.height),
      levels_(static_cast<size_t>(first_.last()) + 1),
      begin_(first_.first()),
      level_(begin_) {}

void ProgressiveRender::restart() {
  for (auto& level : levels_) {
    if (!level) continue;
    std::ranges::fill(level->done, 0);
    level->least = 0;
  }
  level_ = begin_ = first_.first();
  is_unseen_ = true;
  const std::lock_guard lock(mutex_);
  shown_ = beneath_ = nullptr;
  denoised_.clear();
  samples_ = 0;
}

void ProgressiveRender::run(Progress& progress) {
  prepare_scene(progress);
  progress.stage("rendering", 0.0, 1.0);
  start_ = std::chrono::steady_clock::now();
  try {
    for (render_level(progress); !is_last(); render_level(progress)) ++level_;
  } catch (...) {
    measure_first(false);
    throw;
  }
}

/// Chooses the first level of the next image by the time of this one.
void ProgressiveRender::measure_first(bool is_whole) {
  if (!std::exchange(is_unseen_, false)) return;
  first_.took(std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(), is_whole);
}

/// Prepares hierarchy, lights, and what the strategy needs; kept while only the camera moves.
void ProgressiveRender::prepare_scene(Progress& progress) {
  progress.stage("building the BVH", 0.0, 0.0);
  scene_->commit(asked_.threads, &progress);
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
  std::unique_ptr<Level>& made = levels_[static_cast<size_t>(level_)];
  if (!made) {
    const int divisor = first_.divisor(level_);
    PassOptions passes;
    if (is_last() && asked_.denoise) passes.asked = pass::kHalves;
    made = std::make_unique<Level>(divided(asked_.width, divisor), divided(asked_.height, divisor), passes);
  }
  Level& level = *made;
  set_options(level);
  if (level.least == 0 && std::ranges::all_of(level.done, [](int n) { return n == 0; })) level.film.clear();
  const int total = context_->camera_rays();
  while (level.least < total) {
    const int target = std::min(level.least + std::clamp(level.least, 1, kMaxPass), total);
    render_pass(level, target, progress);
    level.least = target;
    if (is_last() && asked_.denoise && (std::has_single_bit(static_cast<unsigned>(target)) || target == total)) {
      show(denoised(level.film, progress));
    } else {
      show();
    }
    measure_first(true);
    if (is_last()) progress.update(static_cast<double>(target) / total);
  }
}

void ProgressiveRender::render_pass(Level& level, int target, Progress& progress) {
  tbb::enumerable_thread_specific<TileRenderer> renderers([this] { return TileRenderer(*context_); });
  arena_.execute([&] {
    tbb::parallel_for(size_t{0}, level.tiles.size(), [&](size_t t) {
      int& done = level.done[t];
      if (done >= target) return;  // done before a cancellation
      renderers.local().render(level.tiles[t], done, target - done, level.film, nullptr, progress);
      done = target;
      if (level_ > begin_) show();
    });
  });
}

/// Denoised image, RGBA.
std::vector<float> ProgressiveRender::denoised(const Film& film, const Progress& progress) const {
  const std::vector<float> colors = denoised_colors(film, asked_.threads, progress);
  std::vector<float> pixels(4 * (colors.size() / 3));
  film.read_pass("Combined", pixels);
  for (size_t i = 0; i < colors.size() / 3; ++i) std::copy_n(&colors[3 * i], 3, &pixels[4 * i]);
  return pixels;
}

/// The first level is shown only once it is complete, as there is nothing beneath it. A denoised image stays until the
/// next one.
void ProgressiveRender::show(std::vector<float> denoised) {
  const std::lock_guard lock(mutex_);
  if (denoised.empty() && !denoised_.empty()) return;
  denoised_ = std::move(denoised);
  const auto level = static_cast<size_t>(level_);
  shown_ = levels_[level].get();
  beneath_ = shown_->least == 0 && level_ > begin_ ? levels_[level - 1].get() : nullptr;
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
    throw Error(Status::invalid_argument, "The image has " + std::to_string(count) +
                                              " values, but the given buffer has room for only " +
                                              std::to_string(pixels.size()) + ".");
  }
  if (!denoised_.empty()) {
    std::ranges::copy(denoised_, pixels.begin());
    return {film.width(), film.height(), samples_, version_};
  }
  film.read_over(beneath_ != nullptr ? &beneath_->film : nullptr, pixels.first(count));
  return {film.width(), film.height(), samples_, version_};
}

}  // namespace velour
