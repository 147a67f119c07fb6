// Radiance that surfaces send along given rays.
#pragma once

#include <vector>

#include "render/paths_in_flight.h"

namespace velour {

/// One per thread. Estimates what TileRenderer counts beyond the first continuation ray of a path: light from lights,
/// environment and emissive meshes at every surface of the path, and the emission of these surfaces where
/// DirectLight::counts_glow() is false. Where it is true at the first surface, the caller of add() counts the emission.
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
