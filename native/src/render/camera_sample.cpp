#include "render/camera_sample.h"

namespace velour {

void PixelSum::add(const CameraSample& sample) {
  if (camera_rays == 0) depth = sample.depth;
  radiance += sample.radiance;
  alpha += sample.alpha;
  normal += sample.normal;
  luminance[camera_rays % 2] += velour::luminance(sample.radiance);
  ++camera_rays;
  directions += static_cast<uint32_t>(sample.directions);
}

double PixelSum::mean_luminance() const {
  return (static_cast<double>(luminance[0]) + static_cast<double>(luminance[1])) / camera_rays;
}

double PixelSum::variance() const {
  const double odd = camera_rays / 2, even = camera_rays - camera_rays / 2, n = camera_rays;
  const double difference = static_cast<double>(luminance[0]) / even - static_cast<double>(luminance[1]) / odd;
  // E difference^2 = v (1/even + 1/odd) where a half of k rays has variance v / k, and the mean has v / n.
  return difference * difference * even * odd / (n * n);
}

}  // namespace velour
