// Delta lights, which no sampled direction can hit, at one vertex.
#pragma once

#include "render/lights/lighting.h"
#include "render/path_numbers.h"
#include "render/vertex.h"

namespace velour {

/// Light of a delta light that is above both the shading horizon and the surface; ignores shadows.
struct SharpLight {
  const Lamp* lamp;
  float distance;
  Vec3 wl, wl_world;
  Rgb irradiance;  // perpendicular, divided by the selection probability
};

inline constexpr size_t kMaxDeltaLights = 64;

/// Finds each delta light once if `found` has room for all (up to kMaxDeltaLights), otherwise as many as it has room
/// for, sampled by contribution (Lighting::sharp_view). Returns the number of lights in `found`: those that illuminate
/// the vertex.
int find_sharp_light(const Lighting& lighting, const Vertex& vertex, PathNumbers& numbers, std::span<SharpLight> found);

}  // namespace velour
