// Rays. The only header over Embree; embree_scene.cpp and embree_meshes.cpp (with embree_api.h) see Embree's own
// headers and hide the difference between Embree 3 and 4. Embree is opened privately (dlopen + dlsym), so that another
// Embree already in the process - Blender's - cannot be bound by accident.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>

#include "job/progress.h"
#include "scene/affine.h"
#include "sphere/vec.h"

namespace velour {

struct Ray {
  Vec3 origin;
  float near = 0.0f;
  Vec3 direction;  // unit where distances matter
  float far = std::numeric_limits<float>::infinity();
};

inline constexpr uint32_t kNoHit = 0xffffffffu;

struct Hit {
  float distance;
  // World, not normalised, towards the front: the side that sees the mesh's corners counter-clockwise in object space,
  // so that the outside of a mirrored instance stays outside.
  Vec3 geometric_normal;
  float u, v;                  // barycentric weights of vertices 1 and 2
  uint32_t triangle;           // of the mesh
  uint32_t instance = kNoHit;  // kNoHit: the ray met nothing
  /// What VisibleRays has found behind the crossing of a shell (ShellHit); NaN: it was not asked.
  float shell_begin = 0, shell_s = std::numeric_limits<float>::quiet_NaN();
};

/// Meshes and instances of them. Build, then trace from any number of threads. Changes need another commit(). A scene
/// that changes has two levels, so that its meshes stay built. One that stays as it is has one, with the triangles of
/// all instances in their places: a mesh that is turned renders in a fifth less time.
class EmbreeScene {
 public:
  EmbreeScene();
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  /// Copies the geometry. Returns the mesh's number.
  uint32_t add_mesh(std::span<const Vec3> positions, std::span<const glm::uvec3> triangles);
  /// Puts another mesh in the place of one; without triangles it takes no memory.
  void set_mesh(uint32_t number, std::span<const Vec3> positions, std::span<const glm::uvec3> triangles);
  /// Takes the meshes of `other`, which is committed, in the place of its own: no geometry is copied, no mesh is built
  /// again. Neither may add meshes while the other is traced.
  void share_meshes(const EmbreeScene& other);
  /// Returns the instance's number, counted from 0.
  uint32_t add_instance(uint32_t mesh, const Affine& object_to_world);
  void clear_instances();
  enum class Levels { one, two };
  /// Builds; uses at most `threads` threads (0: all). A scene whose only instance has the identity map has one level in
  /// any case; else one level is made only where instances repeat little: where they have more than kMostRepeated
  /// triangles for each of their meshes, there are two. Throws Error(cancelled) soon after `progress` was: what is
  /// built of meshes for two levels goes on, and another commit() waits for it.
  void commit(int threads, const Progress* progress = nullptr, Levels levels = Levels::two);
  static constexpr double kMostRepeated = 1.5;

  /// As committed.
  Levels levels() const;

  void intersect(const Ray& ray, Hit& hit) const;
  bool occluded(const Ray& ray) const;
  /// A batch; blocked[i] is 1 where ray i meets anything. Rays of one batch should start near each other.
  void occluded(std::span<const Ray> rays, uint8_t* blocked) const;
  void intersect(std::span<const Ray> rays, Hit* hits) const;
  /// The same for parallel rays whose neighbours in the batch are neighbours in space, traced in packets: two to three
  /// times as fast there, slower elsewhere. What a ray meets may depend, at the edge of a triangle, on its packet.
  void occluded_coherent(std::span<const Ray> rays, uint8_t* blocked) const;

  /// Bytes that Embree holds for this scene and those that it shares meshes with.
  uint64_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Version and path of the Embree in use.
struct EmbreeInfo {
  std::string version;
  std::string path;
};
EmbreeInfo embree_info();

/// Throws Error(version_mismatch) when Embree is not the version that this library was compiled for, or when a known
/// ray does not hit a known triangle. Cheap; the result is not cached across failures.
void embree_self_test();

}  // namespace velour
