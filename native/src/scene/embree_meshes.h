// Meshes with their hierarchies: what several scenes may share. Included by embree_*.cpp alone: nothing else sees
// Embree.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "job/progress.h"
#include "scene/affine.h"
#include "scene/embree_api.h"
#include "sphere/vec.h"

namespace velour {

class EmbreeMeshes {
 public:
  EmbreeMeshes();
  ~EmbreeMeshes();
  EmbreeMeshes(const EmbreeMeshes&) = delete;
  EmbreeMeshes& operator=(const EmbreeMeshes&) = delete;

  /// As of EmbreeScene.
  uint32_t add(std::span<const Vec3> positions, std::span<const glm::uvec3> triangles);
  void set(uint32_t number, std::span<const Vec3> positions, std::span<const glm::uvec3> triangles);
  /// Builds those of `numbers` that are new. A cancel ends the waiting, not the building: that goes on, for the next
  /// call to wait for, unless its mesh gives way to another.
  void build(std::span<const uint32_t> numbers, int threads, const Progress* progress);
  /// The triangles of a mesh in another place, not committed; the caller releases them, before the mesh gives way.
  RTCGeometry placed(uint32_t number, const Affine& place) const;
  uint64_t triangles(uint32_t number) const { return sizes_.at(number).triangles; }

  RTCScene new_scene() const;
  /// Throws what stands for an error of Embree.
  static void check(RTCError error);

  RTCDevice device() const { return device_; }
  RTCScene scene(uint32_t number) const { return scenes_.at(number); }
  size_t size() const { return scenes_.size(); }
  int64_t bytes() const { return bytes_.load(std::memory_order_relaxed); }

 private:
  class Build;
  struct Size {
    size_t vertices, triangles;
  };
  RTCScene scene_of(std::span<const Vec3> positions, std::span<const glm::uvec3> triangles) const;
  /// The unbuilt scenes among `numbers`.
  std::vector<RTCScene> unbuilt_scenes(std::span<const uint32_t> numbers) const;
  /// Until the build has ended, whose meshes are no longer unbuilt then.
  void await(const Progress* progress);
  void renew(RTCScene& scene) const;

  const EmbreeApi& api_ = embree();
  std::atomic<int64_t> bytes_{0};
  RTCDevice device_ = nullptr;
  std::vector<RTCScene> scenes_;
  std::vector<Size> sizes_;
  std::vector<uint32_t> unbuilt_;  // of them, by number
  std::unique_ptr<Build> build_;   // that goes on, or whose end nobody has seen
};

}  // namespace velour
