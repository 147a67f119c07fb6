// Paths of one thread that advance from surface to surface together.
#pragma once

#include <vector>
#include "render/path/direct_light.h"
#include "render/path/shadow_queue.h"
#include "render/ray_log.h"

namespace velour {

/// Light directions at vertices after the first: one from the surface and one from the lights suffice for `mis`, and
/// the many camera rays of a pixel average them.
inline constexpr int kIndirectDirections = 2;

struct Path {
  PathNumbers numbers;
  Rgb throughput;
  uint32_t sample;
  RayCone cone;  // at the origin of its ray
  PathPast past{};
  bool counted_all_emissive = false;  // DirectLight::counts_all_emissive() of the vertex that its ray left
};

/// The owner turns hits into `receivers`, alternating with trace() and gather(), and adds the emission of surfaces.
struct PathsInFlight {
  /// `sky`: see DirectLight.
  PathsInFlight(const Scene& scene, const Lighting& lighting, const RenderOptions& options,
                const EnvironmentProductSampler* sky)
      : visible(scene), light(scene, lighting, options, sky) {}

  /// Finds where the rays end and how much of their light is transmitted on the way. Adds light that waited for them to
  /// the samples.
  void trace_camera_rays() { trace({hidden::kFromCamera}); }
  void trace_continued();
  /// Adds the light at the receivers to the samples. Afterwards `paths` holds their continuations if they `go_on`,
  /// otherwise none. Returns the number of shadow rays, which `log` (may be null) receives.
  size_t gather(bool go_on, RayLog* log);

  const VisibleRays visible;
  DirectLight light;
  std::vector<Path> paths;
  std::vector<Ray> rays;            // by path
  std::vector<Hit> hits;            // by path
  std::vector<Receiver> receivers;  // they use the numbers of the paths
  std::vector<CameraSample> samples;

 private:
  /// Adds the continuations of the receivers of the last DirectLight::gather().
  void extend(std::span<const Receiver> batch);
  void trace(const RayKinds& kinds);
  void add_awaited();

  ShadowQueue shadows_;
  std::vector<AwaitedLight> awaited_;  // `place` is the index of the path
  std::vector<Path> next_;
  std::vector<Ray> next_rays_;
  std::vector<uint8_t> kinds_;  // by path
  // Per ray, if rays may pass through surfaces.
  std::vector<Rgb> passed_;
  std::vector<RayDecisions> decisions_;
};

// Radiance that surfaces send along given rays.

/// One per thread. Estimates what TileRenderer counts beyond the first continuation ray of a path: light from lights,
/// environment and emissive meshes at every surface of the path, and the emission of these surfaces where
/// DirectLight::counts_emissive() is false. Where it is true at the first surface, the caller of add() counts the
/// emission.
class IndirectLight {
 public:
  IndirectLight(const Scene& scene, const Lighting& lighting, const RenderOptions& options)
      : scene_(scene), flight_(scene, lighting, options, nullptr) {}

  void clear();
  /// Adds a ray that hit a surface, `cone` at its origin; its radiance goes to a new last element of samples().
  /// `numbers`: those of that surface.
  void add(const Ray& ray, const RayCone& cone, const Hit& hit, const PathNumbers& numbers);
  /// Follows all paths over up to `surfaces` surfaces, one path per ray.
  void resolve(int surfaces);
  /// Results of the rays, in the order of add().
  const std::vector<CameraSample>& samples() const { return flight_.samples; }

 private:
  void meet_surfaces();

  const Scene& scene_;
  PathsInFlight flight_;
};

}  // namespace velour
