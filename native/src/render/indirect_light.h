// Radiance that surfaces send along given rays.
#pragma once

#include <vector>

#include "render/direct_light.h"

namespace velour {

/// One a thread. Estimates what TileRenderer counts beyond a path's first continuing ray: the light of lamps,
/// environment and surfaces that glow at every surface that the path meets, and what of their own emission was not in
/// that (DirectLight::counts_glow; whoever adds rays counts it at the first of them).
class IndirectLight {
 public:
  IndirectLight(const Scene& scene, const Lighting& lighting, const RenderOptions& options)
      : scene_(scene), visible_(scene), light_(scene, lighting, options, nullptr, {}) {}

  void clear();
  /// A ray that met a surface, `cone` at its origin; its radiance will be number `radiance().size()` so far. `numbers`:
  /// those of that surface.
  void add(const Ray& ray, const RayCone& cone, const Hit& hit, const PathNumbers& numbers);
  /// Follows all paths over up to `surfaces` surfaces, one path a ray.
  void resolve(int surfaces);
  /// Of the rays, in the order of add().
  const std::vector<CameraSample>& samples() const { return samples_; }

 private:
  struct Path {
    PathNumbers numbers;
    Rgb throughput;
    uint32_t sample;
    RayCone cone;  // at the origin of its ray
  };
  void meet_surfaces();
  void gather(bool go_on);
  void trace();

  const Scene& scene_;
  const VisibleRays visible_;
  DirectLight light_;
  ShadowQueue shadows_;
  std::vector<Path> paths_, next_;
  std::vector<Ray> rays_, next_rays_;  // of the paths
  std::vector<Hit> hits_;
  std::vector<Rgb> passed_;  // of the rays, where they change their colour
  std::vector<Receiver> receivers_;
  std::vector<CameraSample> samples_;
};

}  // namespace velour
