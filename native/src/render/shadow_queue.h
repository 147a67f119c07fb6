// Light that waits for its shadow ray. Rays of many vertices are traced together.
#pragma once

#include <vector>

#include "render/film.h"
#include "render/visible_rays.h"

namespace velour {

class RayLog;

class ShadowQueue {
 public:
  /// Adds `light` to sample `sample` unless something blocks `ray`, clamped to the sum `limit` of its channels.
  void add(const Ray& ray, const Rgb& light, uint32_t sample, float limit) {
    rays_.push_back(ray);
    light_.push_back(light);
    sample_.push_back(sample);
    limit_.push_back(limit);
  }
  /// Traces all rays, adds the light that arrives to `samples` in the order of add(), and empties the queue. Returns
  /// the number of rays. `log` may be null.
  size_t resolve(const VisibleRays& visible, std::vector<CameraSample>& samples, RayLog* log);

 private:
  std::vector<Ray> rays_;
  std::vector<Rgb> light_;
  std::vector<uint32_t> sample_;
  std::vector<float> limit_;
  std::vector<uint8_t> blocked_;
  std::vector<Rgb> passed_;  // if rays may pass through surfaces
};

}  // namespace velour
