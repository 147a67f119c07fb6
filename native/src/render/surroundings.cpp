#include "render/surroundings.h"

#include "material/material.h"
#include "render/point_site.h"
#include "sphere/directions.h"

namespace velour {
namespace {

constexpr int kProbes = 128;
constexpr int kRaysOfSide = 8;   // through the image, along each side
constexpr int kMostHidden = 64;  // maximum number of hidden surfaces that a ray passes

/// The instance whose back face a ray hits first, if it is opaque there; kNoHit: it hits something else, or nothing.
uint32_t back_met(const Scene& scene, Ray ray) {
  for (int i = 0; i < kMostHidden; ++i) {
    Hit hit;
    scene.rays().intersect(ray, hit);
    if (hit.instance == kNoHit) return kNoHit;
    const SurfaceMaterial& surface = scene.materials()[scene.material(hit)];
    if ((scene.instances()[hit.instance].hidden & hidden::kFromCamera) != 0 ||
        passes_back(surface, ray, hit, hidden::kFromCamera)) {
      ray.near = hit.distance * (1.0f + 1e-5f);
      continue;
    }
    const bool back = glm::dot(hit.geometric_normal, ray.direction) > 0.0f;
    const bool opaque = surface.material->opaque() && !scene.has_shell(hit);
    return back && opaque ? hit.instance : kNoHit;
  }
  return kNoHit;
}

}  // namespace

std::optional<uint32_t> surrounding_instance(const Scene& scene) {
  const Camera& camera = scene.camera();
  const Ray middle = camera.ray(Vec2(0.5f));
  const uint32_t found = back_met(scene, middle);
  if (found == kNoHit) return std::nullopt;
  for (int i = 0; i < kRaysOfSide * kRaysOfSide; ++i) {
    const Vec2 cell(static_cast<float>(i % kRaysOfSide), static_cast<float>(i / kRaysOfSide));
    if (back_met(scene, camera.ray((cell + 0.5f) / static_cast<float>(kRaysOfSide))) != found) return std::nullopt;
  }
  for (const Vec3& direction : sphere_fibonacci(kProbes)) {
    if (back_met(scene, {.origin = middle.origin, .direction = direction}) != found) return std::nullopt;
  }
  return found;
}

}  // namespace velour
