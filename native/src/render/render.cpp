#include "render/render.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <optional>
#include <string>

#include "base/parallel.h"
#include "render/film/noise_target.h"
#include "render/pilot.h"
#include "render/preparation.h"
#include "render/ray_log.h"
#include "render/tile_renderer.h"

namespace velour {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

RenderOptions checked_for(const Scene& scene, const RenderOptions& options, const Film& film) {
  if (film.window() != options.window()) {
    throw Error(Status::invalid_argument, "The size or position of the film does not match the render options.");
  }
  if (options.denoise && !film.options().has(pass::kHalves)) {
    throw Error(Status::invalid_argument, "The film has no pass \"Halves\", which the render option denoise requires.");
  }
  if (!scene.committed()) throw Error(Status::invalid_state, "The scene must be committed before it is rendered.");
  return checked(options);
}

/// Camera rays per pixel of the next pass: doubles, so that a first image appears at once.
int pass_size(const RenderOptions& options, int done, int left) {
  const int asked = options.camera_rays_per_pass;
  const int grown = std::clamp(done, 1, kMaxPass);
  return std::min(asked > 0 ? asked : grown, left);
}

/// One render, from its start to its report.
class Renderer {
 public:
  Renderer(const Scene& scene, const RenderOptions& options, Film& film, Progress& progress)
      : options_(checked_for(scene, options, film)),
        film_(film),
        progress_(progress),
        arena_(arena_concurrency(options_.threads)),
        context_(scene, options_, progress),
        target_(options_.denoise ? 0.0 : options_.noise, blocks_of(options_.window())),
        next_(context_.first_camera_ray()) {
    if (options_.denoise && options_.noise > 0.0) denoised_.emplace(options_.noise, options_.threads);
  }

  RenderReport run() {
    if (!options_.onto_film) film_.clear();
    before_ = film_.directions();
    prepare(context_, arena_, progress_, report_.stages);
    if (pilot_pays(context_)) run_pilot();
    if (context_.sky) report_.sky = context_.sky->report;
    render_passes();
    if (options_.measure_ray_share && !stopped()) measure_ray_share();  // a stop must not wait for it
    return report();
  }

 private:
  void run_pilot() {
    if (pilot_tries_products(context_)) prepare_products(context_, arena_, progress_, report_.stages);
    // If nothing was prepared before, progress stays below kPreparation until the first pass begins.
    run_stage(progress_, report_.stages, "pilot", report_.stages.empty() ? 0.0 : kPreparation, kPreparation,
              [&] { arena_.execute([&] { report_.pilot = choose_mixing(context_, progress_); }); });
    report_.seconds += report_.stages.back().seconds;
  }

  void render_passes() {
    const int first = context_.first_camera_ray(), end = context_.end_camera_ray();
    run_stage(progress_, report_.stages, "render", report_.stages.empty() ? 0.0 : kPreparation, 1.0, [&] {
      const auto start = Clock::now();
      while (next_ < end && !is_done() && !stopped()) {
        const int size = pass_size(options_, next_ - first, end - next_);
        const int count = std::min(size, next_decision() - next_);
        if (report_.passes > 0 && out_of_time(seconds_since(start), count)) break;
        render_pass(count, end - first);
        if (next_ == next_decision()) decide();
      }
    });
    report_.seconds += report_.stages.back().seconds;
  }

  bool is_done() const { return denoised_ ? denoised_->done() : target_.active().empty(); }
  int next_decision() const { return denoised_ ? denoised_->next_decision() : target_.next_decision(); }
  void decide() {
    if (denoised_) {
      denoised_->decide(film_, progress_);
    } else {
      target_.decide(film_);
    }
  }

  bool stopped() const { return options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed); }

  /// Whether a pass of `count` camera rays would end after the limit, which a pilot shortens, at the speed so far.
  bool out_of_time(double seconds, int count) const {
    const double pass = static_cast<double>(count) * static_cast<double>(target_.active().size());
    return options_.time_limit > 0.0 && report_.seconds + seconds * (1.0 + pass / work_) > options_.time_limit;
  }

  void render_pass(int count, int total) {
    std::atomic<size_t> finished{0};
    const int done = next_ - context_.first_camera_ray();
    const std::vector<size_t>& active = target_.active();
    const double done_tiles = 1.0 - static_cast<double>(active.size()) / static_cast<double>(target_.blocks().size());
    arena_.execute([&] {
      tbb::parallel_for(size_t{0}, active.size(), [&](size_t i) {
        TileRenderer& renderer = renderers_.local();
        const PixelRect& tile = target_.blocks()[active[i]];
        share_.record(active[i], tile, count,
                      [&](RayLog* log) { renderer.render(tile, next_, count, film_, log, progress_); });
        const double part = static_cast<double>(++finished) / static_cast<double>(active.size());
        progress_.update(std::max(done_tiles, (done + part * count) / total));
      });
    });
    next_ += count;
    work_ += static_cast<double>(count) * static_cast<double>(active.size());
    ++report_.passes;
  }

  void measure_ray_share() {
    run_stage(progress_, report_.stages, "replay", 1.0, 1.0,
              [&] { arena_.execute([&] { report_.ray_share = share_.measure(context_.scene.rays(), progress_); }); });
  }

  RenderReport report() {
    for (const TileRenderer& renderer : renderers_) {
      report_.rays += renderer.rays();
      report_.nan_samples += renderer.nan_samples();
    }
    const auto directions_before = [&](int camera_ray) {
      return std::min(static_cast<int64_t>(camera_ray) * options_.split, static_cast<int64_t>(options_.spp));
    };
    report_.spp = static_cast<uint64_t>(directions_before(next_) - directions_before(context_.first_camera_ray()));
    const double samples = static_cast<double>(film_.directions() - before_);
    report_.spp_mean = samples / (static_cast<double>(film_.width()) * film_.height());
    report_.samples_per_second = report_.seconds > 0.0 ? samples / report_.seconds : 0.0;
    report_.noise = film_.noise();
    report_.block_noise = target_.worst(film_);
    if (target_.enabled()) report_.blocks_unfinished = target_.active().size();
    return report_;
  }

  const RenderOptions options_;
  Film& film_;
  Progress& progress_;
  tbb::task_arena arena_;
  RenderContext context_;
  NoiseTarget target_;
  std::optional<DenoisedTarget> denoised_;  // if set, used instead of target_
  tbb::enumerable_thread_specific<TileRenderer> renderers_{[this] { return TileRenderer(context_); }};
  RayShare share_{options_.measure_ray_share, options_.split};
  RenderReport report_;
  uint64_t before_ = 0;  // light directions that the film had at the start
  int next_;             // next camera ray of the active tiles
  double work_ = 0;      // camera rays per pixel, summed over tiles
};

}  // namespace

RenderReport render(const Scene& scene, const RenderOptions& options, Film& film, Progress& progress) {
  return Renderer(scene, options, film, progress).run();
}

}  // namespace velour
