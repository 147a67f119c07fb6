// A point of a path, ready for shading: its surface, the area that its ray represents, its program's values.
#pragma once

#include <algorithm>
#include "material/material.h"
#include "material/surface_site.h"
#include "math/sphere/frame.h"
#include "render/lights/light_tree.h"
#include "scene/scene.h"

namespace velour {

// Area of a surface that a ray represents.

/// Width of a ray [Ama84], [AMC21]: meters across at its origin, and growth per meter.
///
/// Cones widen with the length of the path alone. Flat mirrors keep them exact; rough or curved surfaces would widen
/// them further, so textures are looked up at a finer level than necessary, which costs noise but never blurs the
/// image. A cone opened by the density of the sampled direction would blur it, and each strategy would converge to a
/// different image.
struct RayCone {
  float width = 0, spread = 0;
  float part = 1;  // its width as a share of a pixel's

  RayCone at(float distance) const { return {width + distance * spread, spread, part}; }
  /// Width of a whole pixel.
  float pixel() const { return width / part; }
};

/// Two sides of a parallelogram in world space. Only their projection along the ray counts.
struct RaySides {
  Vec3 x, y;
};

/// A square as wide as the cone, perpendicular to unit `direction`.
RaySides across(const RayCone& cone, const Vec3& direction);

/// Footprint of camera rays: a pixel, or less with several rays per pixel. With n camera rays per pixel it is max(1/8,
/// 1/sqrt(n)) of a pixel's side, as in pbrt-v4 [PJH23]: the rays already spread over the pixel and average it, and a
/// texture look-up that averages the whole pixel for each of them would blur the image a second time. At an eighth, 1 %
/// of that remains.
class PixelFootprint {
 public:
  /// `width`, `height`: of the image; `camera_rays`: requested per pixel, even if the render ends early.
  PixelFootprint(const Scene& scene, int width, int height, int camera_rays);

  /// Cone of a camera ray along unit `direction`, at the camera: as wide as its pixel's solid angle, or an orthographic
  /// pixel's area. Empty if no material of the scene varies.
  RayCone cone(const Vec3& direction, float time = kMiddleTime) const {
    return needed_ ? cone_along(direction, time) : RayCone{};
  }
  /// Sides for a camera ray that ends at `position`: exact, by ray differentials [Ige99].
  RaySides sides(const Vec3& position, float time = kMiddleTime) const;

 private:
  RayCone cone_along(const Vec3& direction, float time) const;

  const Camera& camera_;
  const bool needed_;
  float part_;  // of a pixel's side
  Vec2 pitch_;  // size of the footprint of camera rays; meters at distance 1, or anywhere (orthographic)
};

/// Footprint in texture coordinates: `sides` projected along unit `direction` onto the plane through the hit. At
/// grazing angles its stretch is limited by kMinSlope. Zero without texture coordinates.
Mat2 texture_footprint(const RaySides& sides, const Vec3& direction, const Vec3& normal, const TexturePoint& texture);

/// Number of instances with a varying material on a mesh without texture coordinates, which show a single point of the
/// material everywhere.
uint64_t untextured_instances(const Scene& scene);

/// Minimum cosine to the geometric normal in footprints, which are thus at most a thousand times as long as wide.
inline constexpr float kMinSlope = 1e-3f;

// Values that a material's program computes at a hit.

class Program;

/// A hit at which a program is evaluated.
struct ComputedPlace {
  const Scene& scene;
  const Hit& hit;
  const SurfacePoint& point;  // of the hit
  Vec3 incoming;              // unit, towards the viewer, world space
  uint8_t kind;               // of the ray that arrives: a bit of `hidden`
  float step = 0;             // width of a pixel in meters, for bump; 0: small

  bool is_back() const { return glm::dot(point.geometric_normal, incoming) < 0.0f; }
};

/// Fills site.computed. Normals are unit and in world space.
void compute(const Program& program, const ComputedPlace& place, SurfaceSite& site);

class GgxSampler;
class ShellCrossing;
class TableSampler;

/// Surfaces are two-sided: both normals are turned to the viewer's side of the geometric surface. Where interpolation
/// leaves the viewer below the shading horizon, the shading normal is bent toward the viewer until wv.z is
/// kMinCosine: continuous, no division by zero, no black rim; SurfaceMaterial::turned does without that. Light from
/// below the geometric surface does not count unless the material transmits; then light from below both horizons counts
/// as well.
///
/// The frame is right-handed, so a measured sample can be rotated but not mirrored. Where the material varies, +y is
/// the side on which the second texture coordinate increases, so that a texture that is mapped mirrored, or seen from
/// behind, is lit as it looks; the frame may then be left-handed.
struct Vertex {
  static constexpr float kMinCosine = 0.01f;

  Vec3 position;
  Vec3 geometric_normal;  // unit, on the viewer's side
  Frame frame;            // shading frame; z on the viewer's side
  Vec3 wv;                // local
  float offset;           // rays start this far off the surface, along the geometric normal
  float through_offset;   // rays to the other side start this far off it, against the normal
  Vec3 rounding;          // see SurfacePoint
  float terminator;       // see SurfacePoint; 0 if seen from behind
  const SurfaceMaterial* surface;
  const Material* material;   // of `surface`, or the one with corrected normals (SurfaceMaterial::turned)
  const TableSampler* table;  // null unless the strategy needs it
  const GgxSampler* ggx;      // null unless the strategy needs it
  RayCone cone;               // cone of the incoming and of the continuation ray
  SurfaceSite site;           // practically empty for uniform materials
  bool transmits = false;     // Material::transmits()
  float time = kMiddleTime;   // of the path: that of its camera ray

  /// `wv_world`: unit, toward the viewer.
  /// `bends`: the shading normal, as above.
  Vertex(const SurfacePoint& point, const Vec3& wv_world, bool bends = true);
  /// Vertex with its surface and, if the material varies, its site; `cone_at_origin`: at the origin of `ray`. `pixel`:
  /// for camera rays; null for others.
  Vertex(const Scene& scene, const SurfacePoint& point, const Ray& ray, const Hit& hit, const RayCone& cone_at_origin,
         const PixelFootprint* pixel)
      : Vertex(scene, point, nullptr, ray, hit, cone_at_origin, pixel) {}
  /// Vertex at a hit of the rays of the scene; if the surface has a shell, at what the ray hits in it.
  static Vertex seen(const Scene& scene, const Ray& ray, const Hit& hit, const RayCone& cone_at_origin,
                     const PixelFootprint* pixel);

  LightPlace light_place() const { return {position, frame.z, transmits, time}; }

  /// Whether light from direction `wl_world` can reach the viewer; `wl`: the same in the frame.
  bool receives(const Vec3& wl, const Vec3& wl_world) const {
    const float above = glm::dot(wl_world, geometric_normal);
    return (wl.z > 0.0f && above > 0.0f) || (transmits && wl.z < 0.0f && above < 0.0f);
  }

  /// Like receives(), for light whose shadow ray is shadow_ray(): where the mesh stands for a smooth surface, that
  /// surface counts.
  bool receives_light(const Vec3& wl, const Vec3& wl_world) const {
    return receives(wl, wl_world) || (terminator > 0.0f && wl.z > 0.0f);
  }

  /// Radiance that the surface emits toward the viewer, in the working space.
  Rgb emission() const;

  bool goes_through(const Vec3& direction_world) const {
    return transmits && glm::dot(direction_world, geometric_normal) < 0.0f;
  }
  /// Kind of a ray that continues along a direction: a bit of `hidden`.
  uint8_t kind_along(const Vec3& direction_world) const {
    return goes_through(direction_world) ? hidden::kFromTransmission : hidden::kFromBounces;
  }

  /// Ray that starts on the side of the surface that it goes to.
  Ray ray(const Vec3& direction_world, float far) const {
    const float off = goes_through(direction_world) ? -through_offset : offset;
    return {position + off * geometric_normal, 0.0f, direction_world, far, time};
  }

  /// Ray toward light. Directions close to the horizon start on the smooth surface, so that coarse meshes with smooth
  /// normals show no steps. Which directions, and the transition, are as in Cycles (kernel/light/sample.h,
  /// shadow_ray_offset).
  Ray shadow_ray(const Vec3& direction_world, float far) const {
    Ray result = ray(direction_world, far);
    if (terminator > 0.0f) result.origin += lift(direction_world) * rounding;
    return result;
  }

  /// Whether the shadow ray in that direction equals the continuation ray.
  bool rays_agree(const Vec3& direction_world) const { return !(terminator > 0.0f) || lift(direction_world) == 0.0f; }

 private:
  float lift(const Vec3& direction_world) const {
    const float smooth = glm::dot(direction_world, frame.z), flat = glm::dot(direction_world, geometric_normal);
    if (smooth <= 0.0f) return 0.0f;
    return std::clamp(smooth < terminator ? 2.0f - (flat + smooth) / terminator : 1.0f - flat / terminator, 0.0f, 1.0f);
  }

  /// `crossing`: the shell crossing that `point`, on the top of a shell, stands for, or null.
  Vertex(const Scene& scene, const SurfacePoint& point, const ShellCrossing* crossing, const Ray& ray, const Hit& hit,
         const RayCone& cone_at_origin, const PixelFootprint* pixel);
  void find_relief(const Scene& scene, const Hit& hit);
  void find_others(const Scene& scene, const Hit& hit, const Vec3& direction, const RaySides& sides);
  void find_colors(const Scene& scene, const Hit& hit);
  void find_computed(const ComputedPlace& place);
  void find_site(const TexturePoint& texture, const Vec3& direction, const RaySides& sides);
};

// Site of a hit on its material, and whether rays of a kind hit it.

/// Whether `ray` has reached a back face that is hidden from its kind. For shadow rays the direction of the light
/// counts, which comes the other way.
inline bool passes_back(const SurfaceMaterial& surface, const Ray& ray, const Hit& hit, uint8_t kind) {
  if (!surface.hides_backs() || (surface.hidden_backs & kind) == 0) return false;
  const float along = glm::dot(hit.geometric_normal, ray.direction);
  return kind == hidden::kFromShadows ? along < 0.0f : along > 0.0f;
}

/// Site at which a material is queried for opacity and transmission: a point, because the rays of a pixel average what
/// a footprint would. `kind`: a bit of `hidden`.
inline SurfaceSite point_site(const Scene& scene, const Ray& ray, const Hit& hit, const SurfaceMaterial& surface,
                              uint8_t kind) {
  SurfaceSite site;
  if (!surface.material->varies()) return site;
  site.uv = scene.texture(hit).uv;
  for (size_t set = 1; set < surface.uv_sets; ++set) site.others[set - 1].uv = scene.texture(hit, set).uv;
  for (size_t set = 0; set < surface.color_sets; ++set) site.colors[set] = scene.color(hit, set);
  if (surface.opacity) compute(*surface.opacity, {scene, hit, scene.surface(hit), -ray.direction, kind}, site);
  return site;
}

}  // namespace velour
