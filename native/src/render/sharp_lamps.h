// Lamps without extent, which no drawn direction can meet, at one vertex.
#pragma once

#include "render/lighting.h"
#include "render/path_numbers.h"
#include "render/vertex.h"

namespace velour {

/// Light of a sharp lamp that stands above both the shading horizon and the surface; shadows are not looked at.
struct SharpLight {
  const Lamp* lamp;
  float distance;
  Vec3 wl, wl_world;
  Rgb irradiance;  // perpendicular, over the probability of having been chosen
};

inline constexpr size_t kMostSharpLamps = 64;

/// Each sharp lamp once when `found` has room for all (up to kMostSharpLamps), else as many as it has room for, drawn
/// by what they bring (Lighting::sharp_view). Returns how many of them shine on the vertex and are in `found`.
int find_sharp_light(const Lighting& lighting, const Vertex& vertex, PathNumbers& numbers, std::span<SharpLight> found);

}  // namespace velour
