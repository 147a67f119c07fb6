#include "render/visible_rays.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "material/material.h"
#include "render/shell_crossing.h"
#include "sphere/random.h"

namespace velour {
namespace {

float number_of(const Ray& ray, const Hit& hit) {
  uint64_t key = mix64((static_cast<uint64_t>(hit.instance) << 32) + hit.triangle);
  for (const Vec3& v : {ray.origin, ray.direction}) {
    for (int i = 0; i < 3; ++i) key = mix64(key + std::bit_cast<uint32_t>(v[i]));
  }
  return unit_float(key);
}

}  // namespace

VisibleRays::VisibleRays(const Scene& scene)
    : scene_(scene), all_opaque_(std::ranges::all_of(scene.materials(), [](const SurfaceMaterial& m) {
        return m.material->opaque() && !m.shell;
      })) {}

void VisibleRays::intersect(std::span<const Ray> rays, Hit* hits) const {
  scene_.rays().intersect(rays, hits);
  for (size_t i = 0; i < rays.size() && !all_opaque_; ++i) pass_on(rays[i], hits[i]);
}

bool VisibleRays::occluded(const Ray& ray) const {
  uint8_t blocked;
  occluded({&ray, 1}, &blocked);
  return blocked != 0;
}

void VisibleRays::occluded(std::span<const Ray> rays, uint8_t* blocked) const {
  scene_.rays().occluded(rays, blocked);
  for (size_t i = 0; i < rays.size() && !all_opaque_; ++i) {
    if (blocked[i] == 0) continue;
    Hit hit;
    scene_.rays().intersect(rays[i], hit);
    pass_on(rays[i], hit);
    blocked[i] = hit.instance != kNoHit;
  }
}

bool VisibleRays::meets(const Ray& ray, const Hit& hit) const {
  const SurfaceMaterial& surface = scene_.materials()[scene_.material(hit)];
  if (surface.shell && scene_.has_shell(hit) && !ShellCrossing(scene_, ray, hit).meets()) return false;
  const Material& material = *surface.material;
  if (material.opaque()) return true;
  // At a point: what a footprint would average, the rays of a pixel do.
  const Vec2 uv = material.varies() ? scene_.texture(hit).uv : Vec2(0.0f);
  return number_of(ray, hit) < material.alpha({.uv = uv});
}

void VisibleRays::pass_on(Ray ray, Hit& hit) const {
  constexpr float kStep = 0x1p-20f;  // of the distance: the ray tracer's own error
  Hit passed{};
  while (hit.instance != kNoHit) {
    // A ray crosses a triangle once; what is found again is the same crossing, by rounding.
    const bool again = hit.instance == passed.instance && hit.triangle == passed.triangle;
    if (!again && meets(ray, hit)) return;
    passed = hit;
    ray.near = std::nextafter(hit.distance * (1.0f + kStep), ray.far);
    scene_.rays().intersect(ray, hit);
  }
}

}  // namespace velour
