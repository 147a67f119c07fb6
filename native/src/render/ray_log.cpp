#include "render/ray_log.h"

#include <tbb/parallel_for.h>
#include <algorithm>

namespace velour {

void RayLog::add(std::span<const Ray> rays, Kind kind) {
  const double start = thread_seconds();
  rays_.insert(rays_.end(), rays.begin(), rays.end());
  batches_.push_back({rays.size(), kind});
  seconds_ += thread_seconds() - start;
}

double RayLog::replay(const EmbreeScene& scene) const {
  size_t largest = 0;
  for (const Batch& batch : batches_) largest = std::max(largest, batch.count);
  std::vector<Hit> hits(largest);
  std::vector<uint8_t> blocked(largest);
  const double start = thread_seconds();
  const Ray* next = rays_.data();
  for (const Batch& batch : batches_) {
    const std::span<const Ray> rays(next, batch.count);
    if (batch.kind == Kind::nearest) scene.intersect(rays, hits.data());
    if (batch.kind == Kind::occlusion) scene.occluded(rays, blocked.data());
    if (batch.kind == Kind::coherent_occlusion) scene.occluded_coherent(rays, blocked.data());
    next += batch.count;
  }
  return thread_seconds() - start;
}

namespace {

constexpr size_t kMaxSharedRays = 6'000'000;  // 216 MB; memory_estimate.py counts them

/// The top four bits of a golden-ratio hash: one tile in sixteen, not aligned with columns or rows of the image.
bool one_in_sixteen(size_t tile) { return tile * 0x9e3779b97f4a7c15ULL >> 60 == 0; }

}  // namespace

bool RayShare::chosen(size_t tile) const {
  if (!enabled_ || !one_in_sixteen(tile)) return false;
  const std::lock_guard lock(mutex_);
  return rays_ < kMaxSharedRays;
}

RayShare::Record RayShare::new_record(const PixelRect& rect, int count) const {
  Record record;
  const int camera_rays = rect.width() * rect.height() * count;
  record.log.reserve(static_cast<size_t>(camera_rays) * static_cast<size_t>(1 + split_));
  return record;
}

void RayShare::keep(Record record) {
  const std::lock_guard lock(mutex_);
  rays_ += record.log.size();
  records_.push_back(std::move(record));
}

std::optional<double> RayShare::measure(const EmbreeScene& scene, const Progress& progress) const {
  std::vector<double> alone(records_.size());
  tbb::parallel_for(size_t{0}, records_.size(), [&](size_t i) {
    progress.check();
    alone[i] = records_[i].log.replay(scene);
  });
  double rays = 0.0, tiles = 0.0;
  for (size_t i = 0; i < records_.size(); ++i) {
    rays += alone[i];
    tiles += records_[i].seconds;
  }
  return tiles > 0.0 ? std::optional<double>(rays / tiles) : std::nullopt;
}

}  // namespace velour
