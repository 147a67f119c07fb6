// What glows of a mesh with its materials, whatever instances show it: object space.
#pragma once

#include "render/light_tree.h"
#include "scene/scene.h"

namespace velour {

/// Whether the material emits light, on a surface that is itself what is seen.
bool glows(const SurfaceMaterial& material);

/// Luminance of what a triangle sends to every side: near its mean where the material varies, and above 0 wherever the
/// material has any light at all, so that nothing is missed that a mean of texels would round away.
float mean_glow(const SurfaceMaterial& material, const Mesh& mesh, uint32_t triangle, const TextureMap* placed);

/// Immutable. Instances of the same mesh, materials and placements share one.
class GlowGroup {
 public:
  static constexpr uint32_t kNone = 0xffffffffu;

  /// Throws Error(cancelled).
  GlowGroup(const Scene& scene, const Scene::Instance& instance, const Progress& progress);

  /// Triangles that rays are drawn to; the intensity of one is its luminance times its area in the object.
  const LightTree& tree() const { return tree_; }
  uint32_t triangle(uint32_t light) const { return triangle_[light]; }
  /// Its number in the tree; kNone: no rays are drawn to it.
  uint32_t light(uint32_t triangle) const { return light_[triangle]; }
  /// Luminance times area in the world.
  double power(const Mesh& mesh, const Affine& object_to_world) const;

 private:
  std::vector<uint32_t> triangle_;  // by light
  std::vector<uint32_t> light_;     // by triangle
  LightTree tree_;
};

/// Twice the area, along the normal on the mesh's front.
Vec3 double_area(const Mesh& mesh, uint32_t triangle, const Affine& object_to_world);

}  // namespace velour
