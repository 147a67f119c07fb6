// Results of camera rays, and their sums.
#pragma once

#include <cstdint>

#include "math/sphere/vec.h"

namespace velour {

/// Result of one camera ray.
struct CameraSample {
  Rgb radiance{0.0f};
  float alpha = 0;      // 1: covered
  Vec3 normal{0.0f};    // shading normal, world; zero where nothing was hit
  float depth = 1e10f;  // along the camera's viewing axis; 1e10 where nothing was hit, as in Cycles
  int directions = 0;   // number of light directions of the ray
};

/// Sums of the samples of a pixel. Samples must be added in the order of their camera rays, so that the bits do not
/// depend on how the rays are distributed over passes and threads.
struct PixelSum {
  Rgb radiance{0.0f};
  float alpha = 0;
  Vec3 normal{0.0f};
  float depth = 0;              // depth of the first camera ray, as in Cycles: a mean of depths lies on no surface
  float luminance[2] = {0, 0};  // sums over the even and the odd camera rays: the halves (path_numbers.h)
  uint32_t camera_rays = 0, directions = 0;

  void add(const CameraSample& sample);
  /// Adds the sum of the camera rays that follow these.
  void join(const PixelSum& later);

  /// Factor from a sum over the camera rays to their mean; 0 without camera rays.
  float weight() const { return camera_rays > 0 ? 1.0f / static_cast<float>(camera_rays) : 0.0f; }
  double mean_luminance() const;
  /// Estimate of the variance of mean_luminance(), from the difference of the halves. Unbiased if the halves are
  /// independent; too high if they are parts of one Sobol sequence, which is more even than its parts. The
  /// stratification within a half (a Sobol sequence errs far less than independent samples) is accounted for. One
  /// degree of freedom: average it over pixels. Needs two camera rays.
  double variance() const;
};

/// Values that one camera ray contributes to the surface passes. Defaults: nothing was hit, before a black environment.
struct SurfaceSample {
  Vec3 position{0.0f};  // world
  Vec3 uv{0.0f};        // u, v, and 1 if there are texture coordinates
  float object_index = 0, material_index = 0;
  float seen = 0;   // throughput of the path up to there, mean of the channels
  float clear = 0;  // the part of `seen` that is not covered by mist
  Rgb albedo{0.0f};
  Rgb shine{0.0f};  // emission of the surface, or of the environment where nothing was hit
  float object_id = 0, material_id = 0, asset_id = 0;
  /// Motion in the image, pixels: place in the previous frame minus this place; this place minus that in the next
  /// frame.
  Vec2 from_previous{0.0f}, to_next{0.0f};
  float surfaces = 0;  // 1 where something was hit
};

}  // namespace velour
