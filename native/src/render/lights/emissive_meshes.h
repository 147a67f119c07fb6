// Emissive meshes as lights: they are light-sampled, and sampled directions hit them.
#pragma once

#include <memory>
#include "render/lights/light_tree.h"
#include "render/path/vertex.h"
#include "scene/scene.h"

namespace velour {

// Emissive triangles of a mesh with given materials, independent of instances: object space.

/// Whether the material emits light from the mesh itself, i.e. without a shell.
bool emits(const SurfaceMaterial& material);

/// Absolute luminance that a triangle emits to either side: about its mean if the material varies, and above 0 wherever
/// the material emits at all, so that rounding in the mean of texels loses no light. Programs are evaluated on
/// `instance`.
float mean_emission(const SurfaceMaterial& material, const Scene& scene, const Scene::Instance& instance,
                    uint32_t triangle, const TextureMap* placed);

/// Immutable. Shared by instances with the same mesh, materials and placements.
class EmissiveGroup {
 public:
  static constexpr uint32_t kNone = 0xffffffffu;

  /// Throws Error(cancelled).
  EmissiveGroup(const Scene& scene, const Scene::Instance& instance, const Progress& progress);

  /// Light-sampled triangles; the intensity of each is its luminance times its area in object space.
  const LightTree& tree() const { return tree_; }
  uint32_t triangle(uint32_t light) const { return triangle_[light]; }
  /// Index of a triangle in the tree; kNone: it is not light-sampled.
  uint32_t light(uint32_t triangle) const { return light_[triangle]; }
  /// Sum of luminance times area, in world space.
  double power(const Mesh& mesh, const Affine& object_to_world) const;

 private:
  std::vector<uint32_t> triangle_;  // by light
  std::vector<uint32_t> light_;     // by triangle
  LightTree tree_;
};

/// Vector of twice the area, along the normal of the mesh's front.
Vec3 double_area(const Mesh& mesh, uint32_t triangle, const Affine& object_to_world, float time = kMiddleTime);

// Emissive meshes as lights: they are light-sampled, and sampled directions hit them. World space.

/// Hit of a ray with an emissive mesh, whatever lies in between.
struct EmissiveHit {
  size_t ray;  // index of the ray
  Hit hit;
};

/// All triangles of emissive materials, except those of instances hidden from bounces and transmission and those under
/// a shell, whose emission only bounces find. Instances hidden from bounces alone are not light-sampled. Geometry and
/// hierarchies belong to the scene, which must outlive this. Immutable; thread-safe; allocates only for what it finds.
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
  /// Whether a kind of ray, a bit of `hidden`, passes through the instance.
  bool is_hidden(const Hit& hit, uint8_t kind) const { return (scene_.instances()[hit.instance].hidden & kind) != 0; }
  /// Whether that surface is light-sampled.
  bool draws(const Hit& hit) const;

  /// Samples a point of a light at the time of `place`: a triangle by its importance to that position, then uniformly
  /// in its area [Hei19]. `direction`: unit, from the position to the point, or zero if they coincide. `x` and `y` are
  /// uniform in [0, 1).
  Hit sample(uint32_t light, const LightPlace& place, double x, float y, Vec3& direction) const;
  /// Density of sample() per solid angle, for the hit of a ray from `position` along `direction`; `light` receives the
  /// light it belongs to. 0 if the hit is not light-sampled.
  double pdf(const Vec3& position, const Vec3& direction, const Hit& hit, uint32_t& light) const;

  /// Appends the hits of the rays, at most 64, with these surfaces, up to the first one that blocks their light.
  void meet(std::span<const Ray> rays, std::vector<EmissiveHit>& found, const RayKinds& kinds = {}) const;

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
