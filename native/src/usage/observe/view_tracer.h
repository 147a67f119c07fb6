// Views under which camera rays, continued from bounce to bounce, hit one material.
#pragma once

#include <vector>

#include "render/continuation.h"
#include "render/path_numbers.h"
#include "render/shadow_queue.h"
#include "usage/scene_domain.h"

namespace velour {

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
  std::vector<Hit> hits_;
  std::vector<Rgb> passed_;  // by ray, if rays may change color
  ScratchArena arena_;
};

}  // namespace velour
