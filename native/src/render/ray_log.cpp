#include "render/ray_log.h"

#include <algorithm>
#include <chrono>

namespace velour {

void RayLog::add(std::span<const Ray> rays, Kind kind) {
  rays_.insert(rays_.end(), rays.begin(), rays.end());
  batches_.push_back({rays.size(), kind});
}

double RayLog::replay(const EmbreeScene& scene) const {
  size_t largest = 0;
  for (const Batch& batch : batches_) largest = std::max(largest, batch.count);
  std::vector<Hit> hits(largest);
  std::vector<uint8_t> blocked(largest);
  const auto start = std::chrono::steady_clock::now();
  const Ray* next = rays_.data();
  for (const Batch& batch : batches_) {
    const std::span<const Ray> rays(next, batch.count);
    if (batch.kind == Kind::nearest) {
      scene.intersect(rays, hits.data());
    } else {
      scene.occluded(rays, blocked.data());
    }
    next += batch.count;
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace velour
