#include "render/preparation.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace velour {
namespace {

/// options.samples with its end resolved.
SampleRange checked_samples(const RenderOptions& options) {
  const SampleRange range{options.samples.begin, options.samples.end == 0 ? options.spp : options.samples.end};
  const auto whole = [&](int directions) { return directions % options.split == 0 || directions == options.spp; };
  if (range.begin < 0 || range.begin >= range.end || range.end > options.spp) {
    throw Error(Status::invalid_argument,
                "Render option samples is " + std::to_string(range.begin) + ":" + std::to_string(range.end) +
                    "; it must be a range within 0:" + std::to_string(options.spp) + ", the samples per pixel (spp).");
  }
  if (!whole(range.begin) || !whole(range.end)) {
    throw Error(Status::invalid_argument, "Render option samples is " + std::to_string(range.begin) + ":" +
                                              std::to_string(range.end) + "; both ends must be multiples of " +
                                              std::to_string(options.split) +
                                              ", the number of samples that share a camera ray (split).");
  }
  return range;
}

void require_limit(const char* name, float value) {
  if (value >= 0.0f && std::isfinite(value)) return;
  throw Error(Status::invalid_argument, std::string("Render option ") + name + " is " + std::to_string(value) +
                                            "; it must be a finite number of at least 0 (0: off).");
}

/// Sums of pixels are floats: beyond 2^24 camera rays of the same radiance they no longer grow.
void require_summable(const RenderOptions& options) {
  constexpr int kMaxCameraRays = 1 << 24;
  const int rays = options.spp / options.split + (options.spp % options.split != 0 ? 1 : 0);
  if (rays <= kMaxCameraRays) return;
  throw Error(Status::invalid_argument, "Render options spp and split ask for " + std::to_string(rays) +
                                            " camera rays per pixel; a film can add up at most " +
                                            std::to_string(kMaxCameraRays) +
                                            ". Render several images with different seeds and average them.");
}

}  // namespace

void require_range(const char* options, const char* name, int value, int low, int high) {
  if (value >= low && value <= high) return;
  throw Error(Status::invalid_argument, std::string(options) + " option " + name + " is " + std::to_string(value) +
                                            "; it must be between " + std::to_string(low) + " and " +
                                            std::to_string(high) + ".");
}

void check_crop(const RenderOptions& options) {
  const PixelRect crop = options.window();
  if (crop.x0 >= 0 && crop.y0 >= 0 && crop.width() > 0 && crop.height() > 0 && crop.x1 <= options.width &&
      crop.y1 <= options.height) {
    return;
  }
  const auto span = [](int from, int to) { return std::to_string(from) + ":" + std::to_string(to); };
  throw Error(Status::invalid_argument,
              "Render option crop is columns " + span(crop.x0, crop.x1) + ", rows " + span(crop.y0, crop.y1) +
                  "; it must contain pixels and lie within the image of " + std::to_string(options.width) + " x " +
                  std::to_string(options.height) + " pixels.");
}

RenderOptions checked(RenderOptions options) {
  constexpr int kMost = 1 << 30;
  require_range("Render", "width", options.width, 1, 65536);
  require_range("Render", "height", options.height, 1, 65536);
  require_range("Render", "spp", options.spp, 1, kMost);
  require_range("Render", "split", options.split, 1, RenderOptions::kMaxSplit);
  require_range("Render", "bounces", options.bounces, 0, 1024);
  require_range("Render", "threads", options.threads, 0, 4096);
  require_range("Render", "strategy", static_cast<int>(options.strategy), 0, static_cast<int>(kLastStrategy));
  require_range("Render", "camera_rays_per_pass", options.camera_rays_per_pass, 0, kMost);
  require_range("Render", "heuristic", static_cast<int>(options.heuristic), 0, static_cast<int>(Heuristic::power));
  require_range("Render", "sequence", static_cast<int>(options.sequence), 0, static_cast<int>(kLastSequence));
  if (!(options.light_share >= 0.0f && options.light_share <= 1.0f)) {
    throw Error(Status::invalid_argument,
                "Render option share is " + std::to_string(options.light_share) + "; it must be between 0 and 1.");
  }
  const LightPathOptions& paths = options.light_paths;
  require_limit("clamp_direct", paths.clamp_direct);
  require_limit("clamp_indirect", paths.clamp_indirect);
  require_limit("filter_glossy", paths.filter_glossy);
  if (!(options.noise >= 0.0))
    throw Error(Status::invalid_argument,
                "Render option noise is " + std::to_string(options.noise) + "; it must be at least 0.");
  if (!(options.time_limit >= 0.0))
    throw Error(Status::invalid_argument,
                "Render option time_limit is " + std::to_string(options.time_limit) + "; it must be at least 0.");
  options.split = std::min(options.split, options.spp);
  require_summable(options);
  const bool is_part = options.samples.begin > 0 || options.samples.end > 0 || options.crop != PixelRect{};
  if (is_part && options.noise > 0.0) {
    throw Error(Status::invalid_argument,
                "Render option noise requires the whole image, so it cannot be combined with samples or crop.");
  }
  options.samples = checked_samples(options);
  check_crop(options);
  return options;
}

void prepare(RenderContext& context, tbb::task_arena& arena, Progress& progress, std::vector<RenderStage>& stages) {
  const Strategy strategy = context.options.strategy;
  const auto stage = [&](const char* name, const auto& work) {
    run_stage(progress, stages, name, 0.0, kPreparation, work);
  };
  const Scene& scene = context.scene;
  if (strategy == Strategy::table) {
    stage("tables", [&] { arena.execute([&] { context.tables = table_samplers(scene, progress); }); });
  }
  if (surface_sampling(strategy) == SurfaceSampling::ggx) {
    stage("ggx fit", [&] { context.ggx = ggx_samplers(scene, context.options.threads, progress); });
  }
  if (strategy == Strategy::product && !scene.environment().black()) prepare_products(context, arena, progress, stages);
}

void prepare_products(RenderContext& context, tbb::task_arena& arena, Progress& progress,
                      std::vector<RenderStage>& stages) {
  const std::string& folder = context.options.cache_folder;
  const auto make = [&] { context.sky = environment_sampler(context.scene, folder, progress); };
  run_stage(progress, stages, "sky", 0.0, kPreparation, [&] { arena.execute(make); });
}

}  // namespace velour
