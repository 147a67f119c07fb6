// Records the rays of a few tiles, to measure the share of the time that goes into tracing them.
#pragma once

#include <mutex>
#include <optional>
#include <span>
#include <vector>
#include "base/process.h"
#include "base/progress.h"
#include "render/film/film.h"
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

// Share of the render time that goes into tracing rays; at 1, shading would cost nothing.

/// Records the rays of one tile in 16 until kMaxSharedRays are kept, with the CPU time of these tiles. Later traces the
/// same rays alone, with as many threads, and divides.
class RayShare {
 public:
  RayShare(bool enabled, int split) : enabled_(enabled), split_(split) {}

  /// Calls work(log); log is null unless tile `tile` is recorded in this pass of `count` camera rays per pixel.
  template <typename Work>
  void record(size_t tile, const PixelRect& rect, int count, Work&& work) {
    if (!chosen(tile)) {
      work(nullptr);
      return;
    }
    Record record = new_record(rect, count);
    const double start = thread_seconds();
    work(&record.log);
    record.seconds = thread_seconds() - start - record.log.seconds();
    keep(std::move(record));
  }

  /// Seconds of the rays alone / seconds of their tiles; empty if no ray was recorded. Call it in the arena of the
  /// render.
  std::optional<double> measure(const EmbreeScene& scene, const Progress& progress) const;

 private:
  struct Record {
    RayLog log;
    double seconds = 0;
  };
  bool chosen(size_t tile) const;
  Record new_record(const PixelRect& rect, int count) const;
  void keep(Record record);

  const bool enabled_;
  const int split_;
  mutable std::mutex mutex_;
  std::vector<Record> records_;
  size_t rays_ = 0;
};

}  // namespace velour
