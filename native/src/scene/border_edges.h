// Border edges of a surface.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sphere/vec.h"

namespace velour {

/// Edge from corner `corner` of a triangle to the next corner.
struct BorderEdge {
  uint32_t triangle;
  uint32_t corner;
};

/// Edges of the `chosen` triangles that no other chosen triangle shares, in triangle order. Vertices that coincide
/// within a millionth of the surface's extent count as one, so a seam of texture coordinates is not a border.
std::vector<BorderEdge> border_edges(std::span<const Vec3> positions, std::span<const glm::uvec3> triangles,
                                     const std::vector<bool>& chosen);

}  // namespace velour
