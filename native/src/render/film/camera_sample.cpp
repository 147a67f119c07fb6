#include "render/film/camera_sample.h"

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

void PixelSum::join(const PixelSum& later) {
  if (camera_rays == 0) depth = later.depth;
  radiance += later.radiance;
  alpha += later.alpha;
  normal += later.normal;
  // The halves take turns: after an odd number of rays the next one belongs to the second.
  for (uint32_t half = 0; half < 2; ++half) luminance[(camera_rays + half) % 2] += later.luminance[half];
  camera_rays += later.camera_rays;
  directions += later.directions;
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
