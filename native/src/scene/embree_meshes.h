// Meshes with their hierarchies, which several scenes may share. Included by embree_*.cpp only; nothing else sees
// Embree.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "base/progress.h"
#include "math/sphere/affine.h"
#include "math/sphere/vec.h"
#include "scene/embree_api.h"

namespace velour {

/// Any number of threads may call build() and the const functions at once; add() and set() need the meshes alone.
class EmbreeMeshes {
 public:
  EmbreeMeshes();
  ~EmbreeMeshes();
  EmbreeMeshes(const EmbreeMeshes&) = delete;
  EmbreeMeshes& operator=(const EmbreeMeshes&) = delete;

  /// See EmbreeScene::add_mesh() and set_mesh().
  uint32_t add(std::span<const Vec3> positions, std::span<const glm::uvec3> triangles, unsigned steps);
  void set(uint32_t number, std::span<const Vec3> positions, std::span<const glm::uvec3> triangles, unsigned steps);
  /// Builds the meshes among `numbers` that are not built yet. A cancel ends the wait, not the build: the next call
  /// waits for it, except for meshes that have been replaced or are not among its `numbers`.
  void build(std::span<const uint32_t> numbers, int threads, const Progress* progress);
  /// Uncommitted geometry with the mesh's triangles transformed by `place`. The caller must release it before the mesh
  /// is replaced, because both share an index buffer.
  RTCGeometry placed(uint32_t number, const Affine& place) const;
  uint64_t triangles(uint32_t number) const { return sizes_.at(number).triangles; }

  RTCScene new_scene() const;
  /// Throws the Error that corresponds to Embree's error code, if any.
  static void check(RTCError error);

  RTCDevice device() const { return device_; }
  /// Whether Embree was built with ray masks, an option that is off by default in Embree 3.
  bool has_masks() const { return has_masks_; }
  /// Built, and therefore not replaced by a build that fails.
  RTCScene scene(uint32_t number) const {
    const std::lock_guard lock(handles_);
    return scenes_.at(number);
  }
  size_t size() const { return scenes_.size(); }
  int64_t bytes() const { return bytes_.load(std::memory_order_relaxed); }

 private:
  class Build;
  struct Size {
    size_t vertices, triangles;
    unsigned steps;
  };
  RTCScene scene_of(std::span<const Vec3> positions, std::span<const glm::uvec3> triangles, unsigned steps) const;
  /// The unbuilt scenes among `numbers`.
  std::vector<RTCScene> unbuilt_scenes(std::span<const uint32_t> numbers) const;
  /// Stays the same while the mesh does, whatever its scene.
  RTCGeometry geometry_of(uint32_t number) const;
  /// Waits until build_ has ended and takes the meshes that it built from unbuilt_.
  void await(const Progress* progress);
  void renew(RTCScene& scene);

  const EmbreeApi& api_ = embree();
  std::atomic<int64_t> bytes_{0};
  RTCDevice device_ = nullptr;
  bool has_masks_ = false;
  std::vector<RTCScene> scenes_;
  std::vector<Size> sizes_;
  std::vector<uint32_t> unbuilt_;  // numbers of the meshes without a hierarchy
  std::unique_ptr<Build> build_;   // running, or not yet waited for
  std::timed_mutex building_;      // held by build(), for unbuilt_ and build_
  mutable std::mutex handles_;     // held while a handle of scenes_ is read or replaced
};

}  // namespace velour
