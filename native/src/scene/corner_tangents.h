// Tangents for normal maps, in the convention of the programs that bake them.
#pragma once

#include <span>
#include <vector>

#include "sphere/vec.h"

namespace velour {

/// Tangent at a corner. `direction`: unit, perpendicular to the corner's normal, in which the first texture coordinate
/// grows. The bitangent is `side` cross(normal, direction), where `side` is 1, or -1 if the texture is mirrored.
struct CornerTangent {
  Vec3 direction;
  float side;
};

/// Tangent space of Mikkelsen 2008 ("MikkTSpace") on the given triangles, 3 tangents per triangle. Corners with the
/// same position, normal and texture coordinate share the mean tangent of their triangles of the same side, weighted by
/// angle; triangles without area in texture space take one of those. Unlike in MikkTSpace, triangles that share a
/// vertex but no edge form one group. Normals are unit; non-finite texture coordinates count as 0.
std::vector<CornerTangent> corner_tangents(std::span<const Vec3> positions, std::span<const glm::uvec3> triangles,
                                           std::span<const Vec3> corner_normals, std::span<const Vec2> corner_uvs);

}  // namespace velour
