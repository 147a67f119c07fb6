// Meshes with texture coordinates, and a material that asks for them.
#pragma once

#include "support/test_scene.h"

namespace velour::test {

/// Lambert that claims to vary over the surface.
class Varying : public Lambert {
 public:
  using Lambert::Lambert;
  bool varies() const override { return true; }
};

/// square(half) whose texture coordinates are `origin` in its middle and grow by the columns of `map` along x and y, a
/// metre each.
inline Mesh textured_square(float half, const Mat2& map, const Vec2& origin = Vec2(0.5f)) {
  const std::vector<Vec3> p = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
  const std::vector<glm::uvec3> t = {{0, 1, 2}, {0, 2, 3}};
  std::vector<Vec2> uvs;
  for (const glm::uvec3& triangle : t) {
    for (int k = 0; k < 3; ++k) uvs.push_back(origin + map * Vec2(p[triangle[k]]));
  }
  return Mesh({.positions = p, .triangles = t, .corner_uvs = uvs});
}

/// The same with `repeats` of a texture, the first from corner to corner.
inline Mesh repeating_square(float half, float repeats) {
  return textured_square(half, Mat2(repeats / (2 * half)), Vec2(repeats / 2));
}

/// sphere(n) with longitude and latitude, 0 to 1, as texture coordinates.
inline Mesh textured_sphere(uint32_t n) {
  const Mesh plain = sphere(n);
  std::vector<Vec2> uvs;
  for (const glm::uvec3& t : plain.triangles()) {
    for (int k = 0; k < 3; ++k) {
      const uint32_t row = t[k] / (2 * n + 1), column = t[k] % (2 * n + 1);
      uvs.emplace_back(static_cast<float>(column) / static_cast<float>(2 * n),
                       1 - static_cast<float>(row) / static_cast<float>(n));
    }
  }
  return Mesh({.positions = plain.positions(), .triangles = plain.triangles(), .corner_uvs = uvs});
}

}  // namespace velour::test
