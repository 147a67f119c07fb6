// Radiance that surfaces send along given rays.
#pragma once

#include <vector>

#include "render/paths_in_flight.h"

namespace velour {

/// One a thread. Estimates what TileRenderer counts beyond a path's first continuing ray: the light of lamps,
/// environment and surfaces that glow at every surface that the path meets, and what of their own emission was not in
/// that (DirectLight::counts_glow; whoever adds rays counts it at the first of them).
class IndirectLight {
 public:
  IndirectLight(const Scene& scene, const Lighting& lighting, const RenderOptions& options)
      : scene_(scene), flight_(scene, lighting, options, nullptr) {}

  void clear();
  /// A ray that met a surface, `cone` at its origin; its radiance will be number `radiance().size()` so far. `numbers`:
  /// those of that surface.
  void add(const Ray& ray, const RayCone& cone, const Hit& hit, const PathNumbers& numbers);
  /// Follows all paths over up to `surfaces` surfaces, one path a ray.
  void resolve(int surfaces);
  /// Of the rays, in the order of add().
  const std::vector<CameraSample>& samples() const { return flight_.samples; }

 private:
  void meet_surfaces();

  const Scene& scene_;
  PathsInFlight flight_;
};

}  // namespace velour
