#include "render/render.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <string>

#include "fit/ggx_fit.h"
#include "job/threads.h"
#include "render/lights_part.h"
#include "render/noise_target.h"
#include "render/ray_share.h"
#include "render/tile_renderer.h"
#include "scene/sky_misfit.h"

namespace velour {
namespace {

using Clock = std::chrono::steady_clock;

/// Camera rays a pixel of a whole-grown pass: a tile stays below 10 ms, so a cancel is seen soon.
constexpr int kLargestPass = 8;
/// What tables or fits before the first pass take of the whole, roughly.
constexpr double kPreparation = 0.05;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

void require_range(const char* name, int value, int low, int high) {
  if (value >= low && value <= high) return;
  throw Error(Status::invalid_argument, "Render option " + std::string(name) + " is " + std::to_string(value) +
                                            "; it must lie between " + std::to_string(low) + " and " +
                                            std::to_string(high) + ".");
}

RenderOptions checked(const Scene& scene, RenderOptions options, const Film& film) {
  constexpr int kMost = 1 << 30;
  require_range("width", options.width, 1, 65536);
  require_range("height", options.height, 1, 65536);
  require_range("spp", options.spp, 1, kMost);
  require_range("split", options.split, 1, RenderOptions::kMaxSplit);
  require_range("bounces", options.bounces, 0, 1024);
  require_range("threads", options.threads, 0, 4096);
  require_range("strategy", static_cast<int>(options.strategy), 0, static_cast<int>(Strategy::product));
  require_range("camera_rays_per_pass", options.camera_rays_per_pass, 0, kMost);
  require_range("heuristic", static_cast<int>(options.heuristic), 0, static_cast<int>(Heuristic::power));
  require_range("sequence", static_cast<int>(options.sequence), 0, static_cast<int>(Sequence::sobol));
  if (!(options.light_share >= 0.0f && options.light_share <= 1.0f)) {
    throw Error(Status::invalid_argument,
                "Render option share is " + std::to_string(options.light_share) + "; it must lie between 0 and 1.");
  }
  if (!(options.noise >= 0.0)) throw Error(Status::invalid_argument, "Render option noise is negative.");
  if (!(options.time_limit >= 0.0)) throw Error(Status::invalid_argument, "Render option time_limit is negative.");
  if (film.width() != options.width || film.height() != options.height) {
    throw Error(Status::invalid_argument, "The film has another size than the render options ask for.");
  }
  if (!scene.committed()) throw Error(Status::invalid_state, "The scene must be committed before it is rendered.");
  options.split = std::min(options.split, options.spp);
  return options;
}

/// Camera rays a pixel of the next pass: doubling, so that a first picture appears at once.
int pass_size(const RenderOptions& options, int done, int total) {
  const int asked = options.camera_rays_per_pass;
  const int grown = std::clamp(done, 1, kLargestPass);
  return std::min(asked > 0 ? asked : grown, total - done);
}

/// One render, from its start to its report.
class Renderer {
 public:
  Renderer(const Scene& scene, const RenderOptions& options, Film& film, Progress& progress)
      : options_(checked(scene, options, film)),
        film_(film),
        progress_(progress),
        arena_(arena_concurrency(options_.threads)),
        context_{scene, options_, Lighting(scene), {}, {}, nullptr, {}},
        target_(options_.noise, blocks_of(options_.width, options_.height)) {}

  RenderReport run() {
    film_.clear();
    prepare_tables();
    fit_ggx_lobes();
    prepare_sky();
    render_passes();
    if (options_.measure_ray_share) measure_ray_share();
    return report();
  }

 private:
  template <typename Work>
  void stage(const char* name, double begin, double end, Work&& work) {
    progress_.stage(name, begin, end);
    const auto start = Clock::now();
    work();
    report_.stages.push_back({name, seconds_since(start)});
  }

  void prepare_tables() {
    if (options_.strategy != Strategy::table) return;
    const auto& materials = context_.scene.materials();
    context_.tables.resize(materials.size());
    stage("tables", 0.0, kPreparation, [&] {
      for (size_t m = 0; m < materials.size(); ++m) {
        progress_.check();
        arena_.execute([&] { context_.tables[m] = std::make_unique<const TableSampler>(*materials[m].material); });
      }
    });
  }

  void fit_ggx_lobes() {
    if (surface_sampling(options_.strategy) != SurfaceSampling::ggx) return;
    const auto& materials = context_.scene.materials();
    stage("ggx fit", 0.0, kPreparation, [&] {
      for (const SurfaceMaterial& m : materials) {
        context_.ggx.push_back(std::make_unique<const GgxSampler>(fit_ggx(*m.material, options_.threads, progress_)));
      }
    });
  }

  void prepare_sky() {
    const Environment& environment = context_.scene.environment();
    if (options_.strategy != Strategy::product || environment.black()) return;
    stage("sky", 0.0, kPreparation, [&] {
      arena_.execute([&] {
        const SkyMixture sky = sky_mixture(environment, {}, options_.cache_folder, progress_);
        context_.sky = std::make_unique<const SkyProposals>(sky, sky_misfit(environment, sky));
        context_.lights_part = lights_parts(context_.scene, *context_.sky);
        report_.sky = RenderReport::Sky{sky.size(), sky.relative_l2, sky.seconds, sky.cached};
      });
    });
  }

  void render_passes() {
    const int total = context_.camera_rays();
    stage("render", report_.stages.empty() ? 0.0 : kPreparation, 1.0, [&] {
      const auto start = Clock::now();
      while (done_ < total && !target_.active().empty()) {
        const int count = std::min(pass_size(options_, done_, total), target_.next_decision() - done_);
        if (report_.passes > 0 && out_of_time(seconds_since(start), count)) break;
        render_pass(count, total);
        if (done_ == target_.next_decision()) target_.decide(film_);
      }
    });
    report_.seconds = report_.stages.back().seconds;
  }

  /// Whether a pass of `count` camera rays would end after the limit, at the speed so far.
  bool out_of_time(double seconds, int count) const {
    const double pass = static_cast<double>(count) * static_cast<double>(target_.active().size());
    return options_.time_limit > 0.0 && seconds * (1.0 + pass / work_) > options_.time_limit;
  }

  void render_pass(int count, int total) {
    std::atomic<size_t> finished{0};
    const std::vector<size_t>& active = target_.active();
    const double done_tiles = 1.0 - static_cast<double>(active.size()) / static_cast<double>(target_.blocks().size());
    arena_.execute([&] {
      tbb::parallel_for(size_t{0}, active.size(), [&](size_t i) {
        TileRenderer& renderer = renderers_.local();
        const PixelRect& tile = target_.blocks()[active[i]];
        share_.record(active[i], tile, count,
                      [&](RayLog* log) { renderer.render(tile, done_, count, film_, log, progress_); });
        const double part = static_cast<double>(++finished) / static_cast<double>(active.size());
        progress_.update(std::max(done_tiles, (done_ + part * count) / total));
      });
    });
    done_ += count;
    work_ += static_cast<double>(count) * static_cast<double>(active.size());
    ++report_.passes;
  }

  void measure_ray_share() {
    stage("replay", 1.0, 1.0,
          [&] { arena_.execute([&] { report_.ray_share = share_.measure(context_.scene.rays(), progress_); }); });
  }

  RenderReport report() {
    for (const TileRenderer& renderer : renderers_) {
      report_.rays += renderer.rays();
      report_.nan_samples += renderer.nan_samples();
    }
    report_.spp = static_cast<uint64_t>(
        std::min(static_cast<int64_t>(done_) * options_.split, static_cast<int64_t>(options_.spp)));
    const double samples = static_cast<double>(film_.directions());
    report_.spp_mean = samples / (static_cast<double>(options_.width) * options_.height);
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
  tbb::enumerable_thread_specific<TileRenderer> renderers_{[this] { return TileRenderer(context_); }};
  RayShare share_{options_.measure_ray_share, options_.split};
  RenderReport report_;
  int done_ = 0;     // camera rays a pixel of the active tiles
  double work_ = 0;  // camera rays a pixel, summed over tiles
};

}  // namespace

RenderReport render(const Scene& scene, const RenderOptions& options, Film& film, Progress& progress) {
  return Renderer(scene, options, film, progress).run();
}

}  // namespace velour
