// Tangents of normal maps, as the programs that bake them have them.
#pragma once

#include <span>
#include <vector>

#include "sphere/vec.h"

namespace velour {

/// Of a corner: unit `direction` in which the first texture coordinate grows, normal to the corner's normal; the second
/// one's is `side` cross(normal, direction), with a side of 1, or -1 where the picture lies mirrored.
struct CornerTangent {
  Vec3 direction;
  float side;
};

/// 3 a triangle: the tangent space of Mikkelsen 2008 ("MikkTSpace"), on the triangles as they are. Corners of one
/// position, normal and texture coordinate share what the triangles about them have of one side, weighted by the angle
/// there; triangles whose picture has no area take what is there. Triangles that share a place but no edge are one
/// group here. Normals are unit; texture coordinates that are not finite count as 0.
std::vector<CornerTangent> corner_tangents(std::span<const Vec3> positions, std::span<const glm::uvec3> triangles,
                                           std::span<const Vec3> corner_normals, std::span<const Vec2> corner_uvs);

}  // namespace velour
