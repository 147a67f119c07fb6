// Ray tracing. The only public header over Embree: embree_scene.cpp and embree_meshes.cpp (with embree_api.h) include
// Embree's own headers and hide the differences between Embree 3 and 4. Embree is opened privately (dlopen + dlsym), so
// that another Embree already in the process - Blender's - cannot be bound by accident.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>

#include "base/progress.h"
#include "math/sphere/affine.h"
#include "math/sphere/vec.h"
#include "scene/motion.h"

namespace velour {

struct Ray {
  Vec3 origin;
  float near = 0.0f;
  Vec3 direction;  // unit where distances matter
  float far = std::numeric_limits<float>::infinity();
  float time = kMiddleTime;  // 0..1, while the shutter is open
};

/// Kinds of rays as bits, the same for all rays or one each. Which bit is which kind is up to the caller, except kAny.
struct RayKinds {
  static constexpr uint8_t kAny = 0x80;  // no kind in particular: a ray that no instance is hidden from
  uint8_t all = kAny;
  std::span<const uint8_t> each = {};

  uint8_t operator[](size_t ray) const { return each.empty() ? all : each[ray]; }
  RayKinds part(size_t first, size_t count) const { return {all, each.empty() ? each : each.subspan(first, count)}; }
};

inline constexpr uint32_t kNoHit = 0xffffffffu;

struct Hit {
  float distance;
  // World space, not normalized, towards the front: the side from which the mesh's corners are counterclockwise in
  // object space, so that the outside of a mirrored instance stays outside.
  Vec3 geometric_normal;
  float u, v;                  // barycentric weights of vertices 1 and 2
  uint32_t triangle;           // of the mesh
  uint32_t instance = kNoHit;  // kNoHit: the ray hit nothing
  /// Found by VisibleRays behind the crossing of a shell (ShellHit); NaN: not computed.
  float shell_begin = 0, shell_s = std::numeric_limits<float>::quiet_NaN();
  float time = kMiddleTime;  // of the ray
};

/// Meshes and instances of them. After commit(), any number of threads may trace. Changes need another commit(). A
/// scene that changes has two levels, so that its meshes stay built. A static scene has one level with the transformed
/// triangles of all instances that do not move, which takes a fifth less time to render a rotated mesh.
class EmbreeScene {
 public:
  EmbreeScene();
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  /// Copies the geometry and returns the mesh's number. A mesh that deforms has the positions of all `steps` in a row,
  /// at even times from 0 to 1; they are linear in between.
  uint32_t add_mesh(std::span<const Vec3> positions, std::span<const glm::uvec3> triangles, unsigned steps = 1);
  /// Replaces a mesh. A mesh without triangles takes no memory.
  void set_mesh(uint32_t number, std::span<const Vec3> positions, std::span<const glm::uvec3> triangles,
                unsigned steps = 1);
  /// Replaces this scene's meshes by those of `other`, which is committed. Copies no geometry and rebuilds no mesh.
  /// Neither scene may add meshes while the other is traced.
  void share_meshes(const EmbreeScene& other);
  /// Returns the instance's number, counted from 0. `steps`: transforms of an instance that moves, at even times from 0
  /// to 1 and linear in between (motion_steps()); none: it stays at `object_to_world`. Rays of the kinds `hidden_from`,
  /// bits other than RayKinds::kAny, do not meet the instance; with any, throws Error(unsupported) if Embree was built
  /// without ray masks.
  uint32_t add_instance(uint32_t mesh, const Affine& object_to_world, std::span<const Affine> steps = {},
                        uint8_t hidden_from = 0);
  void clear_instances();
  enum class Levels { one, two };
  /// Builds with at most `threads` threads (0: all). A scene whose only instance has the identity transform and is not
  /// hidden always has one level. Otherwise there are two if instances repeat their meshes much: if they have more than
  /// kMaxRepeated triangles per triangle of their meshes. Throws Error(cancelled) soon after `progress` is canceled;
  /// builds of meshes for two levels continue, and another commit() waits for them.
  void commit(int threads, const Progress* progress = nullptr, Levels levels = Levels::two);
  static constexpr double kMaxRepeated = 1.5;

  /// Levels of the committed scene, whatever moves.
  Levels levels() const;

  void intersect(const Ray& ray, Hit& hit) const;
  bool occluded(const Ray& ray) const;
  /// Traces a batch; blocked[i] is 1 if ray i hits anything, else 0. Rays of a batch should start near each other.
  void occluded(std::span<const Ray> rays, uint8_t* blocked, RayKinds kinds = {}) const;
  void intersect(std::span<const Ray> rays, Hit* hits, RayKinds kinds = {}) const;
  /// Like occluded(), but traces packets: two to three times as fast for parallel rays whose neighbors in the batch are
  /// neighbors in space, slower for others. At triangle edges, a ray's result may depend on its packet.
  void occluded_coherent(std::span<const Ray> rays, uint8_t* blocked) const;

  /// Bytes that Embree holds for this scene and all scenes that share its meshes.
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

/// Throws Error(version_mismatch) if Embree is not the version that this library was compiled for, or if a known ray
/// misses a known triangle. Cheap; failures are not cached.
void embree_self_test();

}  // namespace velour
