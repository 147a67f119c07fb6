// A hit as a point of its material.
#pragma once

#include "material/material.h"
#include "scene/scene.h"

namespace velour {

/// Where a material is asked for what is there and what passes: at a point, because what a footprint would average the
/// rays of a pixel do.
inline SurfaceSite point_site(const Scene& scene, const Hit& hit, const SurfaceMaterial& surface) {
  SurfaceSite site;
  if (!surface.material->varies()) return site;
  site.uv = scene.texture(hit).uv;
  for (size_t set = 1; set < surface.uv_sets; ++set) site.others[set - 1].uv = scene.texture(hit, set).uv;
  for (size_t set = 0; set < surface.color_sets; ++set) site.colors[set] = scene.color(hit, set);
  return site;
}

}  // namespace velour
