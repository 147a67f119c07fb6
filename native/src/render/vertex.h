// A point of a path, ready to be shaded.
#pragma once

#include <algorithm>

#include "render/footprint.h"
#include "render/light_tree.h"
#include "scene/scene.h"
#include "sphere/frame.h"

namespace velour {

class GgxSampler;
class ShellCrossing;
class TableSampler;

/// Surfaces are two-sided: both normals are turned to the viewer's side of the geometric surface. Where interpolation
/// leaves the viewer below the shading horizon, the shading normal is bent towards the viewer until wv.z is
/// kLeastCosine: continuous, no division by zero, no black rim. Light from below the geometric surface counts as
/// nothing, unless the material transmits: then light from below both horizons counts as well.
///
/// The frame is right-handed: a measured swatch can be turned, not mirrored. Where the material varies, +y is the side
/// to which the second texture coordinate grows, so that a picture of a surface that is mapped mirrored, or seen from
/// behind, is lit as it looks; the frame then may be left-handed.
struct Vertex {
  static constexpr float kLeastCosine = 0.01f;

  Vec3 position;
  Vec3 geometric_normal;  // unit, on the viewer's side
  Frame frame;            // shading frame; z on the viewer's side
  Vec3 wv;                // local
  float offset;           // a ray starts this far off the surface, along the geometric normal
  float through_offset;   // and one to the other side this far against it
  Vec3 rounding;          // as of SurfacePoint; none seen from behind
  float terminator;
  const SurfaceMaterial* surface;
  const TableSampler* table;  // null unless the strategy needs it
  const GgxSampler* ggx;      // the same
  RayCone cone;               // of the ray that came here, and of the one that goes on
  SurfaceSite site;           // as good as empty where the material is uniform
  bool transmits = false;     // Material::transmits()

  /// `wv_world`: unit, towards the viewer.
  Vertex(const SurfacePoint& point, const Vec3& wv_world);
  /// The same with its surface and, where that varies, its site; `cone` at the origin of `ray`. `pixel`: of a camera
  /// ray, null of others.
  Vertex(const Scene& scene, const SurfacePoint& point, const Ray& ray, const Hit& hit, const RayCone& cone_at_origin,
         const PixelFootprint* pixel)
      : Vertex(scene, point, nullptr, ray, hit, cone_at_origin, pixel) {}
  /// The same of a hit of the scene's own; where the surface has a shell, at what the ray meets there.
  static Vertex seen(const Scene& scene, const Ray& ray, const Hit& hit, const RayCone& cone_at_origin,
                     const PixelFootprint* pixel);

  LightPlace light_place() const { return {position, frame.z, transmits}; }

  /// Whether light from there can reach the viewer; `wl`: the same in the frame.
  bool receives(const Vec3& wl, const Vec3& wl_world) const {
    const float above = glm::dot(wl_world, geometric_normal);
    return (wl.z > 0.0f && above > 0.0f) || (transmits && wl.z < 0.0f && above < 0.0f);
  }

  /// The same of light whose shadow ray is shadow_ray(): where the mesh stands for a smooth surface, that surface
  /// counts.
  bool receives_light(const Vec3& wl, const Vec3& wl_world) const {
    return receives(wl, wl_world) || (terminator > 0.0f && wl.z > 0.0f);
  }

  /// Radiance that the surface itself sends to the viewer, in the working space.
  Rgb emission() const;

  /// From the side of the surface that it goes to.
  Ray ray(const Vec3& direction_world, float far) const {
    const bool through = transmits && glm::dot(direction_world, geometric_normal) < 0.0f;
    return {position + (through ? -through_offset : offset) * geometric_normal, 0.0f, direction_world, far};
  }

  /// A ray towards light. Directions close to the horizon begin on the smooth surface: coarse meshes with smooth
  /// normals show no steps. Which ones, and the transition, is Cycles' (kernel/light/sample.h, shadow_ray_offset).
  Ray shadow_ray(const Vec3& direction_world, float far) const {
    Ray result = ray(direction_world, far);
    if (terminator > 0.0f) result.origin += lift(direction_world) * rounding;
    return result;
  }

  /// Whether a ray towards light is the one with which a path goes on in that direction.
  bool rays_agree(const Vec3& direction_world) const { return !(terminator > 0.0f) || lift(direction_world) == 0.0f; }

 private:
  float lift(const Vec3& direction_world) const {
    const float smooth = glm::dot(direction_world, frame.z), flat = glm::dot(direction_world, geometric_normal);
    if (smooth <= 0.0f) return 0.0f;
    return std::clamp(smooth < terminator ? 2.0f - (flat + smooth) / terminator : 1.0f - flat / terminator, 0.0f, 1.0f);
  }

  /// `crossing`: null, or what `point`, on the top of a shell, stands for.
  Vertex(const Scene& scene, const SurfacePoint& point, const ShellCrossing* crossing, const Ray& ray, const Hit& hit,
         const RayCone& cone_at_origin, const PixelFootprint* pixel);
  void find_relief(const Scene& scene, const Hit& hit);
  void find_others(const Scene& scene, const Hit& hit, const Vec3& direction, const RaySides& sides);
  void find_colors(const Scene& scene, const Hit& hit);
  void find_site(const SurfacePoint& point, const TexturePoint& texture, const Vec3& direction, const RaySides& sides);
};

}  // namespace velour
