// Paths of one thread that go from surface to surface together.
#pragma once

#include <vector>

#include "render/direct_light.h"
#include "render/ray_log.h"
#include "render/visible_rays.h"

namespace velour {

/// Light directions of a vertex beyond the first: one from each side suffices for `mis`, and the many camera rays of a
/// pixel average them.
inline constexpr int kIndirectDirections = 2;

struct Path {
  PathNumbers numbers;
  Rgb throughput;
  uint32_t sample;
  RayCone cone;  // at the origin of its ray
  PathPast past{};
};

/// Whoever has them makes `receivers` of the hits, in turns with trace() and gather(), and counts what surfaces emit.
struct PathsInFlight {
  /// `sky` as of DirectLight.
  PathsInFlight(const Scene& scene, const Lighting& lighting, const RenderOptions& options, const SkySampler* sky)
      : visible(scene), light(scene, lighting, options, sky) {}

  /// Where the rays end, and what of their light comes through on the way. Light that waited for them is added to the
  /// samples. `kind`: a bit of `hidden`.
  void trace(uint8_t kind);
  /// Adds the light at the receivers to the samples. The paths then are those that go on from them, if they `go_on`,
  /// else none. The number of shadow rays, which `log` (may be null) receives.
  size_t gather(bool go_on, RayLog* log);

  const VisibleRays visible;
  DirectLight light;
  std::vector<Path> paths;
  std::vector<Ray> rays;            // of the paths
  std::vector<Hit> hits;            // of the rays
  std::vector<Receiver> receivers;  // with numbers of the paths
  std::vector<CameraSample> samples;

 private:
  /// Adds the paths that go on from the receivers of the last DirectLight::gather().
  void extend(std::span<const Receiver> batch);
  void add_awaited();

  ShadowQueue shadows_;
  std::vector<AwaitedLight> awaited_;  // by number of the path
  std::vector<Path> next_;
  std::vector<Ray> next_rays_;
  // Of the rays, where they may pass what they come to.
  std::vector<Rgb> passed_;
  std::vector<RayDecisions> decisions_;
};

}  // namespace velour
