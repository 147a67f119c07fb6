#include "capture/btf/btf_capture.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "btf/measure/pair_layout.h"
#include "capture/btf/tile_checks.h"
#include "capture/btf/view_capture.h"
#include "math/sphere/random.h"

namespace velour {
namespace {

using Clock = std::chrono::steady_clock;

constexpr uint32_t kMaxSamples = 16384, kMaxBounces = 1024;

void check_counts(const BtfCaptureOptions& options) {
  const auto check = [](uint32_t value, uint32_t low, uint32_t high, const char* what) {
    if (value >= low && value <= high) return;
    throw Error(Status::invalid_argument, std::string("A capture cannot have ") + std::to_string(value) + " " + what +
                                              "; the number must be " + std::to_string(low) + " to " +
                                              std::to_string(high) + ".");
  };
  check(options.texels[0], 1, kMaxTexelsAlong, "texels along x");
  check(options.texels[1], 1, kMaxTexelsAlong, "texels along y");
  check(options.sampling.samples, 1, kMaxSamples, "samples per texel");
  check(options.sampling.bounces, 0, kMaxBounces, "bounces");
}

std::vector<PolarAngles> with_mirror_images(std::vector<PolarAngles> set) {
  const std::vector<PolarAngles> mirrored = below(set);
  set.insert(set.end(), mirrored.begin(), mirrored.end());
  return set;
}

bool any_below(const std::vector<PolarAngles>& set) {
  return std::any_of(set.begin(), set.end(), [](const PolarAngles& d) { return d.theta > 90; });
}

class BtfCapturer {
 public:
  BtfCapturer(const Scene& scene, const BtfCaptureOptions& options, const std::string& path, Progress& progress)
      : scene_(scene),
        options_(options),
        path_(path),
        progress_(progress),
        tile_(scene, place_of(scene, options.place), options.threads, progress),
        tile_sha256_(tile_hash(tile_, progress)) {}

  BtfCaptureReport run() {
    inspect();
    find_reference_plane();
    const BtfFolderWriter writer(path_, index(), options_.resume);
    capture_views(writer);
    progress_.stage("checking the tile", 0.97, 1);
    writer.finish(progress_);
    report_.bytes = writer.bytes();
    return report_;
  }

 private:
  void inspect() {
    report_.open = is_open(tile_);
    const bool wanted =
        options_.sides == CaptureSides::two || (options_.sides == CaptureSides::automatic && report_.open);
    layout_ = layout(wanted);
    report_.two_sided = any_below(layout_->views()) || any_below(layout_->lights());
    report_.warnings = scene_.info().warnings;
    std::erase(report_.warnings, warning<WarningCode::no_light>());  // the capture supplies its own lights
    if (const auto seam = seam_warning(tile_)) report_.warnings.push_back(*seam);
    for (const SurfaceMaterial& m : scene_.materials()) {
      if (m.emission == Rgb(0)) continue;
      report_.warnings.push_back(warning<WarningCode::tile_emits_light>());
      break;
    }
  }

  PairLayout layout(bool two_sided) const {
    if (options_.held_out > 0) return held_out_pairs(options_.held_out, two_sided);
    const bool given = any_below(options_.views) || any_below(options_.lights);
    if (!two_sided || given) return {options_.views, options_.lights};
    return {with_mirror_images(options_.views), with_mirror_images(options_.lights)};
  }

  /// Held-out pairs use other random numbers, so that the noise of the fitted data does not recur in the test data.
  TexelSampling sampling() const {
    TexelSampling sampling = options_.sampling;
    if (options_.held_out > 0) sampling.seed = mix64(~sampling.seed);
    return sampling;
  }

  void find_reference_plane() {
    progress_.stage("finding the reference plane", 0, 0.03);
    height_ = options_.reference_height ? static_cast<float>(*options_.reference_height)
                                        : least_variance_height(tile_, any_below(layout_->views()), progress_);
    if (height_ < tile_.bottom()) {
      throw Error(Status::invalid_argument,
                  "The reference plane at z = " + std::to_string(height_) +
                      " is below the lowest point of the tile, z = " + std::to_string(tile_.bottom()) + ". Raise it.");
    }
    report_.thickness = static_cast<double>(tile_.thickness()) * length_unit();
    report_.reference_height = static_cast<double>(height_ - tile_.bottom()) * length_unit();
  }

  /// Meters per scene unit, or tile widths per scene unit if the size of a unit is unknown.
  double length_unit() const {
    return options_.metres_per_unit > 0 ? options_.metres_per_unit : 1 / static_cast<double>(tile_.period().x);
  }

  BtfIndex index() const {
    TexelGrid grid{options_.texels[0], options_.texels[1]};
    if (options_.metres_per_unit > 0) grid.tile_metres = tile_.period() * static_cast<float>(options_.metres_per_unit);
    return {.layout = *layout_,
            .grid = grid,
            .shell = Shell{report_.thickness, report_.reference_height},
            .source = options_.source,
            .options = options_json(),
            .structure = true,
            .errors = options_.sampling.samples > 1};
  }

  std::string options_json() const {
    const TilePlace& place = tile_.place();
    return nlohmann::ordered_json{{"samples", options_.sampling.samples},
                                  {"bounces", options_.sampling.bounces},
                                  {"seed", options_.sampling.seed},
                                  {"origin", {place.origin.x, place.origin.y}},
                                  {"period", {place.period.x, place.period.y}},
                                  {"metres_per_unit", options_.metres_per_unit},
                                  {"tile_sha256", tile_sha256_}}
        .dump();
  }

  void capture_views(const BtfFolderWriter& writer) {
    progress_.stage("capturing views", 0.03, 0.97);
    const BtfIndex index = this->index();
    ViewCapture capture(tile_, index.grid, height_, sampling());
    RayShare share(options_.measure_ray_share, static_cast<int>(layout_->lights().size()));
    const auto views = static_cast<uint32_t>(layout_->views().size());
    for (uint32_t v = 0; v < views; ++v) {
      progress_.check();
      if (writer.has(v)) {
        ++report_.views_resumed;
      } else {
        capture_view(v, index, capture, writer, options_.measure_ray_share ? &share : nullptr);
      }
      progress_.update((v + 1.0) / views);
    }
    report(capture);
    if (options_.measure_ray_share) report_.ray_share = share.measure(tile_.rays(), progress_);
  }

  void capture_view(uint32_t v, const BtfIndex& index, ViewCapture& capture, const BtfFolderWriter& writer,
                    RayShare* share) {
    const ViewSetup view(tile_, index.layout, v);
    const uint64_t texels = index.grid.texels(), pairs = view.lights.size();
    const uint64_t values = 3 * pairs * texels, errors = index.errors ? pairs * texels : 0;
    const ViewStore store(values + errors, options_.memory_limit, path_);
    const std::vector<float> none(texels);
    ViewImages images{store.halves().first(values), store.halves().subspan(values), {none, none, none}, &store};
    const auto start = Clock::now();
    const double all = static_cast<double>(layout_->views().size());
    capture.run(view, images, v / all, (v + 1) / all, share, progress_);
    report_.seconds += std::chrono::duration<double>(Clock::now() - start).count();
    for (auto* map : {&images.structure.height_mean, &images.structure.height_spread}) {
      for (float& height : *map) height *= static_cast<float>(length_unit());
    }
    store.read_by([&] { writer.write(v, {images.values, images.errors, &images.structure}, progress_); });
  }

  void report(const ViewCapture& capture) {
    const CaptureCounts counts = capture.counts();
    report_.rays = counts.rays;
    report_.rays_per_second = report_.seconds > 0 ? static_cast<double>(counts.rays) / report_.seconds : 0;
    report_.views = static_cast<uint32_t>(layout_->views().size());
    report_.lights = static_cast<uint32_t>(layout_->lights().size());
    report_.pairs = layout_->pairs();
    if (counts.lost > 0) report_.warnings.push_back(warning<WarningCode::rays_lost>({{"rays", counts.lost}}));
    if (counts.broken > 0) {
      report_.warnings.push_back(warning<WarningCode::path_values_not_finite>({{"values", counts.broken}}));
    }
  }

  const Scene& scene_;
  const BtfCaptureOptions& options_;
  const std::string path_;
  Progress& progress_;
  const RepeatedTile tile_;
  const std::string tile_sha256_;
  std::optional<PairLayout> layout_;
  float height_ = 0;
  BtfCaptureReport report_;
};

}  // namespace

BtfCaptureReport capture_btf(const Scene& scene, const BtfCaptureOptions& options, const std::string& path,
                             Progress& progress) {
  check_counts(options);
  BtfCaptureReport report;
  tbb::task_arena arena(arena_concurrency(options.threads));
  arena.execute([&] { report = BtfCapturer(scene, options, path, progress).run(); });
  return report;
}

}  // namespace velour
