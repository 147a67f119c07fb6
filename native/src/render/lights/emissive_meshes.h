// Emissive meshes as lights: they are light-sampled, and sampled directions hit them. World space.
#pragma once

#include <memory>

#include "render/footprint.h"
#include "render/lights/emissive_group.h"

namespace velour {

/// Hit of a ray with an emissive mesh, whatever lies in between.
struct EmissiveHit {
  size_t ray;  // index of the ray
  Hit hit;
};

/// All triangles of emissive materials, except those of instances hidden from bounces and those under a shell, whose
/// emission only bounces find. Geometry and hierarchies belong to the scene, which must outlive this. Immutable;
/// thread-safe; allocates only for what it finds.
class EmissiveMeshes {
 public:
  /// `scene` must be committed. Throws Error(cancelled): preparing the choice among millions of triangles takes
  /// seconds.
  EmissiveMeshes(const Scene& scene, const Progress& progress);

  bool empty() const { return places_.empty(); }
  /// Light-sampled instances, one light each, for the choice between them.
  std::span<const LightTree::Light> lights() const { return lights_; }

  /// Whether a hit of the scene's rays is on one of these surfaces.
  bool holds(const Hit& hit) const;
  /// Whether that surface is light-sampled.
  bool draws(const Hit& hit) const;

  /// Samples a point of a light at the time of `place`: a triangle by its importance to that position, then uniformly
  /// in its area [Hei19]. `direction`: unit, from the position to the point, or zero if they coincide. `x` and `y` are
  /// uniform in [0, 1).
  Hit sample(uint32_t light, const LightPlace& place, double x, float y, Vec3& direction) const;
  /// Density of sample() per solid angle, for the hit of a ray from `position` along `direction`; `light` receives the
  /// light it belongs to. 0 if the hit is not light-sampled.
  double pdf(const Vec3& position, const Vec3& direction, const Hit& hit, uint32_t& light) const;

  /// Appends the hits of the rays, at most 64, with these surfaces, up to the first opaque one.
  void meet(std::span<const Ray> rays, std::vector<EmissiveHit>& found) const;

  struct Light {
    Rgb radiance;  // times the alpha of the surface
    float far;     // end of a shadow ray along `ray`: just before the surface
  };
  /// Light from such a point along a ray back to its origin; `cone`: at that origin.
  Light light(const Ray& ray, const Hit& hit, const RayCone& cone) const;

 private:
  struct Place {
    uint32_t instance;  // index in the scene
    uint32_t group;
    Affine to_object;  // in the middle of its motion
    uint32_t light;    // index in lights_, or EmissiveGroup::kNone
  };
  bool stops(const Hit& hit) const;
  const EmissiveGroup& group(const Place& place) const { return groups_[place.group]; }
  const Place* place(uint32_t instance) const {
    return place_of_[instance] == EmissiveGroup::kNone ? nullptr : &places_[place_of_[instance]];
  }
  void find_places(const Progress& progress);
  void find_lights(const Progress& progress);

  const Scene& scene_;
  std::vector<uint8_t> emits_;  // by material
  std::vector<EmissiveGroup> groups_;
  std::vector<Place> places_;       // by instance of rays_
  std::vector<uint32_t> place_of_;  // by instance of the scene, or EmissiveGroup::kNone; empty if nothing emits
  std::vector<LightTree::Light> lights_;
  std::vector<uint32_t> lit_;  // index in places_, by light
  std::unique_ptr<EmbreeScene> rays_;
};

}  // namespace velour
