#include "render/shadow_queue.h"

#include "render/light_paths.h"
#include "render/ray_log.h"

namespace velour {

size_t ShadowQueue::resolve(const VisibleRays& visible, std::vector<CameraSample>& samples, RayLog* log) {
  const size_t count = rays_.size();
  blocked_.resize(count);
  if (log != nullptr) log->add(rays_, RayLog::Kind::occlusion);
  passed_.resize(visible.dims() ? count : 0);
  visible.occluded(rays_, blocked_.data(), visible.dims() ? passed_.data() : nullptr);
  for (size_t i = 0; i < passed_.size(); ++i) light_[i] *= passed_[i];
  for (size_t i = 0; i < count; ++i) {
    if (blocked_[i] == 0) samples[sample_[i]].radiance += clamped(light_[i], limit_[i]);
  }
  rays_.clear();
  light_.clear();
  sample_.clear();
  limit_.clear();
  return count;
}

}  // namespace velour
