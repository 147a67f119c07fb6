// Everything that a picture is made of, as plain arrays.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "material/texture_map.h"
#include "scene/camera.h"
#include "scene/embree_scene.h"
#include "scene/environment.h"
#include "scene/light.h"
#include "scene/mesh.h"

namespace velour {

class Material;

/// What a material slot points to.
struct SurfaceMaterial {
  std::shared_ptr<const Material> material;
  Rgb emission{0.0f};         // radiance of both sides, working space
  bool rec709_colors = true;  // f is Rec. 709 (measured) and is taken to the working space; false: already there
};

/// A hit, resolved to what shading needs. World space.
struct SurfacePoint {
  Vec3 position;
  Vec3 geometric_normal;  // unit, towards the mesh's front
  Vec3 shading_normal;    // unit, interpolated, towards the mesh's front
  Vec3 tangent;           // along the first texture coordinate as placed, not normalised; zero when there is none
  float error;            // bound of |position - exact|, per coordinate
  uint32_t material;
};

/// Of a scene that is rendered; those that are only traced need none.
inline constexpr const char* kNoLightWarning = "The scene has no light.";
/// What a material that varies over the surface needs beside it, as placed. Of a mesh without texture coordinates, or
/// with ones that are not finite, it is that of (0, 0), without gradients.
struct TexturePoint {
  Vec2 uv{0.0f};
  /// d uv / d position on the triangle's plane, world space, for any transform of the instance; zero where the triangle
  /// is too small for float64.
  Vec3 u_gradient{0.0f}, v_gradient{0.0f};
};

struct SceneInfo {
  uint64_t triangles = 0;  // over all instances
  uint64_t instances = 0, meshes = 0, lights = 0, materials = 0;
  uint64_t bytes = 0;  // hierarchy, meshes, environment
  double bvh_seconds = 0;
  std::vector<std::string> warnings;
};

/// Fill, commit, render. Every change after commit() needs another commit(). Reading a committed scene is thread-safe.
class Scene {
 public:
  /// These return the number of what was added, counted from 0. Arguments that name missing things throw
  /// Error(invalid_argument).
  uint32_t add_mesh(Mesh mesh);
  uint32_t add_material(SurfaceMaterial material);
  /// Puts another material in the place of one. A committed scene stays committed; nothing may read it meanwhile.
  void set_material(uint32_t number, SurfaceMaterial material);
  /// `materials[s]` serves slot s of the mesh; slots beyond the list use its last entry. An instance without volume (a
  /// zero scale) is left out and counted in the warnings. `placements[s]` takes the mesh's texture coordinates to those
  /// that slot s is shown with, and with them its footprints and its tangents; none: they are the same.
  void add_instance(uint32_t mesh, const Affine& object_to_world, std::vector<uint32_t> materials,
                    std::vector<TextureMap> placements = {});
  uint32_t add_light(const Light& light);
  void set_environment(Environment environment);
  void set_camera(const Camera& camera);
  /// Camera::framing of all instances.
  void frame_camera(float aspect, int up_axis);
  /// Takes Rec. 709 colours to the space of all other colours of the scene and of the film.
  void set_working_space(const Mat3& rec709_to_working);

  /// Checks the scene and builds the hierarchy with at most `threads` threads (0: all).
  void commit(int threads = 0);
  bool committed() const { return rays_ != nullptr; }

  struct Instance {
    uint32_t mesh;
    Affine object_to_world;
    Mat3 normal_to_world;
    std::vector<uint32_t> materials;
    std::vector<TextureMap> placements;  // as many, or none
  };
  const std::vector<Mesh>& meshes() const { return meshes_; }
  /// Hit::instance counts these.
  const std::vector<Instance>& instances() const { return instances_; }

  const EmbreeScene& rays() const { return *rays_; }
  SurfacePoint surface(const Hit& hit) const;
  /// Number of the material that was hit.
  uint32_t material(const Hit& hit) const;
  /// Apart from surface(): most materials are uniform.
  TexturePoint texture(const Hit& hit) const;

  const Camera& camera() const { return camera_; }
  const Environment& environment() const { return environment_; }
  const std::vector<Light>& lights() const { return lights_; }
  const std::vector<SurfaceMaterial>& materials() const { return materials_; }
  /// Nothing when Rec. 709 is the working space.
  const std::optional<Mat3>& rec709_to_working() const { return rec709_to_working_; }
  /// Of all instances, as committed.
  const Bounds& bounds() const { return bounds_; }
  const SceneInfo& info() const { return info_; }

 private:
  void changed();
  uint32_t slot(const Hit& hit) const;
  /// Null where texture coordinates are the mesh's own.
  const TextureMap* placement(const Hit& hit) const;
  TexturePoint texture_of_mesh(const Hit& hit) const;
  Bounds bounds_of_instances() const;
  SceneInfo count() const;

  std::vector<Mesh> meshes_;
  std::vector<Instance> instances_;
  std::vector<SurfaceMaterial> materials_;
  std::vector<Light> lights_;
  uint64_t flat_instances_ = 0;
  Environment environment_;
  Camera camera_;
  std::optional<Mat3> rec709_to_working_;
  std::unique_ptr<EmbreeScene> rays_;
  Bounds bounds_;
  SceneInfo info_;
};

}  // namespace velour
