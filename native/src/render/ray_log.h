// Records the rays of a few tiles, to measure the share of the time that goes into tracing them.
#pragma once

#include <span>
#include <vector>

#include "job/thread_seconds.h"
#include "scene/embree_scene.h"

namespace velour {

class RayLog {
 public:
  enum class Kind { nearest, occlusion, coherent_occlusion };

  void reserve(size_t rays) { rays_.reserve(rays); }
  void add(std::span<const Ray> rays, Kind kind);
  size_t size() const { return rays_.size(); }
  /// Seconds spent in add(), which are not part of the render.
  double seconds() const { return seconds_; }
  /// Traces the same rays in the same order and batches. Returns seconds of thread_seconds().
  double replay(const EmbreeScene& scene) const;

 private:
  struct Batch {
    size_t count;
    Kind kind;
  };
  std::vector<Ray> rays_;
  std::vector<Batch> batches_;
  double seconds_ = 0;
};

}  // namespace velour
