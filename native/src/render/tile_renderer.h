// Work of one thread: camera rays of a tile, advanced from bounce to bounce together.
#pragma once

#include <memory>
#include <vector>
#include "base/progress.h"
#include "material/material.h"
#include "render/film/film.h"
#include "render/film/pass_layout.h"
#include "render/path/path_numbers.h"
#include "render/path/paths_in_flight.h"
#include "render/path/vertex.h"
#include "render/render.h"
#include "render/scene_samplers.h"

namespace velour {

// Values of the surface passes at the first surface that a camera ray hits.

// Albedo: share of light that a surface reflects toward the viewer.

/// Holds scratch memory; one per thread.
class SurfaceAlbedo {
 public:
  explicit SurfaceAlbedo(const std::optional<Mat3>& rec709_to_working) : rec709_to_working_(rec709_to_working) {}

  /// Unbiased estimate of the integral of f cos over the sphere, in the working space, from kDirections directions
  /// sampled by the material; may be above 1. Excludes emission.
  Rgb estimate(const Vertex& vertex, PathNumbers numbers);

 private:
  static constexpr int kDirections = 4;

  const std::optional<Mat3>& rec709_to_working_;
  ScratchArena arena_;
  DirectionBatch drawn_, wl_;
  RgbBatch f_;
  ScalarBatch pdf_;
};

/// Holds scratch memory; one per thread.
class SurfaceRecorder {
 public:
  /// `width`, `height`: of the image in pixels.
  SurfaceRecorder(const Scene& scene, int width, int height)
      : scene_(scene),
        albedo_(scene.rec709_to_working()),
        size_(static_cast<float>(width), static_cast<float>(height)),
        previous_(scene.camera(), 0.0f),
        current_(scene.camera(), kMiddleTime),
        next_(scene.camera(), 1.0f) {}

  /// `vertex`: at `hit`, which a ray reached with throughput `throughput`. `numbers`: of its path.
  SurfaceSample record(const PassOptions& options, const Vertex& vertex, const Hit& hit, const Rgb& throughput,
                       const PathNumbers& numbers);

 private:
  /// Texture coordinates of a set of the mesh, not placed by any material.
  Vec3 uv(const Hit& hit, int set) const;
  float distance(const Vec3& world) const;
  void find_motion(const Hit& hit, SurfaceSample& sample) const;

  const Scene& scene_;
  SurfaceAlbedo albedo_;
  Vec2 size_;
  CameraProjection previous_, current_, next_;
};

/// Shared by all threads during a render, and constant.
struct RenderContext {
  /// Throws Error(cancelled).
  RenderContext(const Scene& of, const RenderOptions& asked, const Progress& progress)
      : scene(of), options(asked), lighting(std::make_shared<const Lighting>(of, progress)) {}
  /// The same scene and samplers with other options.
  RenderContext(const RenderContext& other, const RenderOptions& asked)
      : scene(other.scene),
        options(asked),
        lighting(other.lighting),
        tables(other.tables),
        ggx(other.ggx),
        sky(other.sky),
        mixing(other.mixing) {}

  const Scene& scene;
  const RenderOptions& options;  // split <= spp, samples.end > 0
  std::shared_ptr<const Lighting> lighting;
  // Null unless the strategy needs them.
  std::shared_ptr<const TableSamplers> tables;
  std::shared_ptr<const GgxSamplers> ggx;
  std::shared_ptr<const EnvironmentProductSampler> sky;
  std::vector<Mixing> mixing;  // at the first surface, by material; empty: that of the strategy

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
