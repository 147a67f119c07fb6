#include "render/ray_log.h"

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

}  // namespace velour
