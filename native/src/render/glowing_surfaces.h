// Surfaces that glow, as lights: rays are drawn to them, and drawn directions meet them. World space.
#pragma once

#include <memory>

#include "render/footprint.h"
#include "render/glow_group.h"

namespace velour {

/// Where a ray meets a surface that glows, whatever stands before it.
struct GlowHit {
  size_t ray;  // its number
  Hit hit;
};

/// All triangles of materials that emit, less those of instances that are hidden from bounces and those under a shell:
/// they glow by bounces alone. Geometry and hierarchies are the scene's, which stays. Immutable; thread-safe; no
/// allocation but of what is found.
class GlowingSurfaces {
 public:
  /// `scene` is committed. Throws Error(cancelled): of millions of triangles the choice takes seconds to prepare.
  GlowingSurfaces(const Scene& scene, const Progress& progress);

  bool empty() const { return places_.empty(); }
  /// Those that rays are drawn to, for choosing between them; a light is an instance.
  std::span<const LightTree::Light> lights() const { return lights_; }

  /// Whether what was hit, by a ray of the scene's, is one of these surfaces.
  bool holds(const Hit& hit) const;
  /// Whether rays are drawn to it.
  bool draws(const Hit& hit) const;

  /// A point of a light: a triangle by its importance to `position`, then uniform in its area [Hei19]. `direction`:
  /// unit, from there to the point, or zero where they are one. `x` and `y` are uniform in [0, 1).
  Hit sample(uint32_t light, const Vec3& position, double x, float y, Vec3& direction) const;
  /// The density of that per solid angle, at what the ray from `position` along `direction` has hit, and of which
  /// `light`; 0 where no rays are drawn to it.
  double pdf(const Vec3& position, const Vec3& direction, const Hit& hit, uint32_t& light) const;

  /// Appends what the rays, at most 64, meet of these surfaces, up to the first of them that lets nothing through.
  void meet(std::span<const Ray> rays, std::vector<GlowHit>& found) const;

  struct Light {
    Rgb radiance;  // times how much of the surface is there
    float far;     // of a shadow ray along `ray`: just before the surface
  };
  /// What such a point sends along a ray back to its origin; `cone`: at that origin.
  Light light(const Ray& ray, const Hit& hit, const RayCone& cone) const;

 private:
  struct Place {
    uint32_t instance;  // of the scene
    uint32_t group;
    Affine to_object;
    uint32_t light;  // of lights_, or GlowGroup::kNone
  };
  bool stops(const Hit& hit) const;
  const GlowGroup& group(const Place& place) const { return groups_[place.group]; }
  const Place* place(uint32_t instance) const {
    return place_of_[instance] == GlowGroup::kNone ? nullptr : &places_[place_of_[instance]];
  }
  void find_places(const Progress& progress);
  void find_lights(const Progress& progress);

  const Scene& scene_;
  std::vector<uint8_t> glows_;  // by material
  std::vector<GlowGroup> groups_;
  std::vector<Place> places_;       // by instance of rays_
  std::vector<uint32_t> place_of_;  // by instance of the scene, or GlowGroup::kNone; empty where nothing glows
  std::vector<LightTree::Light> lights_;
  std::vector<uint32_t> lit_;  // by light: its place
  std::unique_ptr<EmbreeScene> rays_;
};

}  // namespace velour
