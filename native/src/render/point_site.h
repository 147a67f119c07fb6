// Site of a hit on its material, and whether rays of a kind hit it.
#pragma once

#include "material/material.h"
#include "scene/scene.h"

namespace velour {

/// Whether `ray` has reached a back face that is hidden from its kind. For shadow rays the direction of the light
/// counts, which comes the other way.
inline bool passes_back(const SurfaceMaterial& surface, const Ray& ray, const Hit& hit, uint8_t kind) {
  if (!surface.hides_backs() || (surface.hidden_backs & kind) == 0) return false;
  const float along = glm::dot(hit.geometric_normal, ray.direction);
  return kind == hidden::kFromShadows ? along < 0.0f : along > 0.0f;
}

/// Site at which a material is queried for opacity and transmission: a point, because the rays of a pixel average what
/// a footprint would.
inline SurfaceSite point_site(const Scene& scene, const Hit& hit, const SurfaceMaterial& surface) {
  SurfaceSite site;
  if (!surface.material->varies()) return site;
  site.uv = scene.texture(hit).uv;
  for (size_t set = 1; set < surface.uv_sets; ++set) site.others[set - 1].uv = scene.texture(hit, set).uv;
  for (size_t set = 0; set < surface.color_sets; ++set) site.colors[set] = scene.color(hit, set);
  return site;
}

}  // namespace velour
