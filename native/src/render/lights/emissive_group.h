// Emissive triangles of a mesh with given materials, independent of instances: object space.
#pragma once

#include "render/lights/light_tree.h"
#include "scene/scene.h"

namespace velour {

/// Whether the material emits light from the mesh itself, i.e. without a shell.
bool emits(const SurfaceMaterial& material);

/// Luminance that a triangle emits to either side: about its mean if the material varies, and above 0 wherever the
/// material emits at all, so that rounding in the mean of texels loses no light. Programs are evaluated on `instance`.
float mean_emission(const SurfaceMaterial& material, const Scene& scene, const Scene::Instance& instance,
                    uint32_t triangle, const TextureMap* placed);

/// Immutable. Shared by instances with the same mesh, materials and placements.
class EmissiveGroup {
 public:
  static constexpr uint32_t kNone = 0xffffffffu;

  /// Throws Error(cancelled).
  EmissiveGroup(const Scene& scene, const Scene::Instance& instance, const Progress& progress);

  /// Light-sampled triangles; the intensity of each is its luminance times its area in object space.
  const LightTree& tree() const { return tree_; }
  uint32_t triangle(uint32_t light) const { return triangle_[light]; }
  /// Index of a triangle in the tree; kNone: it is not light-sampled.
  uint32_t light(uint32_t triangle) const { return light_[triangle]; }
  /// Sum of luminance times area, in world space.
  double power(const Mesh& mesh, const Affine& object_to_world) const;

 private:
  std::vector<uint32_t> triangle_;  // by light
  std::vector<uint32_t> light_;     // by triangle
  LightTree tree_;
};

/// Vector of twice the area, along the normal of the mesh's front.
Vec3 double_area(const Mesh& mesh, uint32_t triangle, const Affine& object_to_world, float time = kMiddleTime);

}  // namespace velour
