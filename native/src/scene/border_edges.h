// Where a surface ends.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sphere/vec.h"

namespace velour {

/// From corner `corner` of a triangle to the next.
struct BorderEdge {
  uint32_t triangle;
  uint32_t corner;
};

/// The edges of the `chosen` triangles that no other chosen triangle shares, in the order of triangles. Vertices at one
/// place, to a millionth of the surface's extent, are one: a seam of texture coordinates is no border.
std::vector<BorderEdge> border_edges(std::span<const Vec3> positions, std::span<const glm::uvec3> triangles,
                                     const std::vector<bool>& chosen);

}  // namespace velour
