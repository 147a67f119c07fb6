// Hits of one material: the views under which paths meet it, and the light that arrives there.
#pragma once

#include <vector>
#include "render/lights/lighting.h"
#include "render/path/direction_sampling.h"
#include "render/path/path_numbers.h"
#include "render/path/paths_in_flight.h"
#include "render/path/shadow_queue.h"
#include "usage/scene_domain.h"

namespace velour {

// Views under which camera rays, continued from bounce to bounce, hit one material.

/// Cells that cover the image evenly; a camera ray goes through a random point of each.
struct CameraGrid {
  uint64_t width, height;
  uint64_t cells() const { return width * height; }
};

/// A hit of the material.
struct SeenHit {
  Vertex vertex;
  int bounces;  // remaining
};

/// Weights of hits, as in SceneDomain.
struct SeenWeights {
  decltype(SceneDomain::view) view{};
  SurfaceDomain surface;
};

/// One per thread.
class ViewTracer {
 public:
  /// Paths are those of a render with `options`, one camera ray per pixel. `draws`: number of hits to sample.
  ViewTracer(const Scene& scene, const SurfaceMaterial& material, const CameraGrid& grid, const RenderOptions& options,
             size_t draws)
      : scene_(scene),
        visible_(scene),
        material_(material),
        grid_(grid),
        options_(options),
        pixel_(scene, options.width, options.height, 1),
        tile_(material.material->texels()),
        draws_(draws) {}

  /// Follows the camera rays of cells [first, end) and adds the weights of their hits to `seen`.
  void follow(uint64_t first, uint64_t end, SeenWeights& seen);

  /// Hits sampled by weight, from all rays followed so far.
  const DrawByWeight<SeenHit>& draws() const { return draws_; }

 private:
  struct Path {
    PathNumbers numbers;
    Rgb throughput;
    uint64_t cell;
    RayCone cone;  // at the origin of its ray
  };
  void start(uint64_t first, uint64_t end);
  void meet(size_t path, int depth, SeenWeights& seen);
  void see(const Vertex& vertex, const Path& path, int depth, SeenWeights& seen);
  void see_surface(const Vertex& vertex, double weight, SurfaceDomain& surface) const;
  void go_on(const Vertex& vertex, const Path& path);

  const Scene& scene_;
  const VisibleRays visible_;
  const SurfaceMaterial& material_;
  const CameraGrid& grid_;
  const RenderOptions& options_;
  const PixelFootprint pixel_;
  const Vec2 tile_;  // texels
  DrawByWeight<SeenHit> draws_;
  std::vector<Path> paths_, next_;
  std::vector<Ray> rays_, next_rays_;  // by path
  std::vector<uint8_t> kinds_;         // of continued rays, by path
  std::vector<Hit> hits_;
  std::vector<Rgb> passed_;  // by ray, if rays may change color
  ScratchArena arena_;
};

// Incident light of one hit: the terms of an ObservedHit.

/// Terms [0, middle) and [middle, end) are independent estimates (ObservedHit).
struct HitLight {
  std::vector<Vec3> wl;
  std::vector<Rgb> light;
  uint32_t middle = 0;
  float light_density = 0;
};

/// Records the terms of the renderer's estimator with their shadows. One per thread.
class HitLightRecorder {
 public:
  /// `options`: of two renders with independent random numbers, one for each half.
  HitLightRecorder(const Scene& scene, const Lighting& lighting, const RenderOptions (&options)[2])
      : visible_(scene),
        lighting_(lighting),
        options_(options),
        direct_{{scene, lighting, options[0], nullptr}, {scene, lighting, options[1], nullptr}},
        indirect_{{scene, lighting, options[0]}, {scene, lighting, options[1]}} {}

  /// Light that arrives at `vertex` over up to `bounces` surfaces. Random numbers are derived from `key`.
  HitLight record(const Vertex& vertex, int bounces, uint64_t key);

 private:
  void record_half(const Vertex& vertex, int bounces, uint64_t key, int half);
  /// Lights, environment and emissive meshes.
  void add_unoccluded_terms();
  /// Light that surfaces reflect.
  void add_surfaces(const Vertex& vertex, int bounces, uint64_t key, int half);
  void add_sharp(const Vertex& vertex, PathNumbers& numbers);
  /// To the sum of a direction; drops light that is not finite, as the renderer does.
  void add(uint32_t direction, const Vec3& wl, const Rgb& light);
  void add_term(const Vec3& wl, const Rgb& light);
  /// Records the luminance of light from lights, environment and emissive meshes with its density (Lighting::sample).
  void note_density(float density, const Rgb& light);
  float light_density();

  const VisibleRays visible_;
  const Lighting& lighting_;
  const RenderOptions (&options_)[2];
  DirectLight direct_[2];
  IndirectLight indirect_[2];
  HitLight result_;

  // For one half.
  IncidentLight incident_;
  std::vector<Ray> rays_;
  std::vector<uint8_t> kinds_;  // by ray
  std::vector<Hit> hits_;
  std::vector<uint8_t> blocked_;
  std::vector<Rgb> passed_;  // transmittance of the rays
  std::vector<size_t> met_;  // paths that hit a surface
  Vec3 wl_[DirectionBatch::kCapacity];
  Rgb light_[DirectionBatch::kCapacity];  // by direction

  // For both halves.
  struct Concentration {
    float density;
    double luminance;
  };
  std::vector<Concentration> concentrations_;
  double irradiance_ = 0;  // luminance
};

}  // namespace velour
