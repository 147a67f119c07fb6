// Work of one thread: camera rays of a tile, advanced from bounce to bounce together.
#pragma once

#include <memory>
#include <vector>

#include "base/progress.h"
#include "render/film/film.h"
#include "render/film/surface_recorder.h"
#include "render/paths_in_flight.h"
#include "render/render.h"
#include "render/scene_samplers.h"

namespace velour {

/// Shared by all threads during a render, and constant.
struct RenderContext {
  /// Throws Error(cancelled).
  RenderContext(const Scene& of, const RenderOptions& asked, const Progress& progress)
      : scene(of), options(asked), lighting(of, progress) {}

  const Scene& scene;
  const RenderOptions& options;  // split <= spp, samples.end > 0
  Lighting lighting;
  // Null unless the strategy needs them.
  std::shared_ptr<const TableSamplers> tables;
  std::shared_ptr<const GgxSamplers> ggx;
  std::shared_ptr<const EnvironmentProductSampler> sky;

  /// Camera rays per pixel of the whole image.
  int camera_rays() const { return rays_of(options.spp); }
  /// Range of camera rays of options.samples.
  int first_camera_ray() const { return rays_of(options.samples.begin); }
  int end_camera_ray() const { return rays_of(options.samples.end); }
  /// Light directions of camera ray `index`: the last one takes the remainder of spp.
  int directions(int index) const { return std::min(options.split, options.spp - index * options.split); }

 private:
  int rays_of(int directions) const { return (directions + options.split - 1) / options.split; }
};

class TileRenderer {
 public:
  explicit TileRenderer(const RenderContext& context);

  /// Adds camera rays [first, first + count) of every pixel of `tile` to `film`. `log` (may be null) receives the rays.
  /// Throws Error(cancelled) soon after a cancellation.
  void render(const PixelRect& tile, int first, int count, Film& film, RayLog* log, const Progress& progress);

  uint64_t rays() const { return ray_count_; }
  uint64_t nan_samples() const { return flight_.light.nan_samples(); }

 private:
  void start_paths(const PixelRect& run, int first, int count);
  void aim_paths(const PixelRect& run, int count);
  void trace(int depth, RayLog* log);
  void follow(size_t path, int depth);
  void add_background();
  void render_run(const PixelRect& run, int first, int count, size_t pixel, RayLog* log);
  /// Adds the samples to the sums of the pixels of the tile, from index `pixel` on.
  void add_samples(int count, size_t pixel);

  const RenderContext& context_;
  const PixelFootprint pixel_;
  PathsInFlight flight_;
  SurfaceRecorder recorder_;
  std::vector<SurfaceSample> surfaces_;  // by sample, if the film has surface passes
  struct Miss {
    uint32_t sample;
    Vec3 direction;
    Rgb throughput;
  };
  std::vector<Miss> missed_;  // camera rays that hit nothing
  // For the current tile:
  const Film* film_ = nullptr;
  std::vector<PixelSum> pixels_;
  std::vector<float> values_;
  uint64_t ray_count_ = 0;
};

}  // namespace velour
