// What camera rays bring, and their sum.
#pragma once

#include <cstdint>

#include "sphere/vec.h"

namespace velour {

/// What one camera ray brings.
struct CameraSample {
  Rgb radiance{0.0f};
  float alpha = 0;      // 1: the pixel is covered
  Vec3 normal{0.0f};    // shading normal, world; zero where nothing was hit
  float depth = 1e10f;  // along the line of sight; as is: nothing was hit (Cycles writes the same)
  int directions = 0;   // light directions that the ray stands for
};

/// Sums a pixel. Samples of a pixel must be added in the order of their camera rays: then the bits do not depend on how
/// the rays are dealt out to passes and threads.
struct PixelSum {
  Rgb radiance{0.0f};
  float alpha = 0;
  Vec3 normal{0.0f};
  float depth = 0;              // of the first camera ray, as Cycles does: a mean of depths lies on no surface
  float luminance[2] = {0, 0};  // of the even and of the odd camera rays: the halves (path_numbers.h)
  uint32_t camera_rays = 0, directions = 0;

  void add(const CameraSample& sample);
  /// Adds the sum of camera rays that come after these.
  void join(const PixelSum& later);

  /// A sum over the camera rays times this is their mean; 0 where there are none.
  float weight() const { return camera_rays > 0 ? 1.0f / static_cast<float>(camera_rays) : 0.0f; }
  double mean_luminance() const;
  /// Estimate of the variance of mean_luminance(), from the difference of the halves; unbiased where these are
  /// independent, too high where they are parts of one Sobol sequence, which is more even than its parts: what holds
  /// inside a half (a Sobol sequence errs far less than independent samples) is in it. One degree of freedom: to be
  /// averaged over pixels. Needs two camera rays.
  double variance() const;
};

/// What the passes of surfaces say of what one camera ray has met; as is: nothing, before a black sky.
struct SurfaceSample {
  Vec3 position{0.0f};  // world
  Vec3 uv{0.0f};        // and 1, where there are texture coordinates
  float object_index = 0, material_index = 0;
  float seen = 0;   // what is left of light that comes from there, mean of the channels
  float clear = 0;  // of that, what no mist covers
  Rgb albedo{0.0f};
  Rgb shine{0.0f};  // what comes from there by itself: of a glowing surface, or of the sky where nothing was met
  float object_id = 0, material_id = 0, asset_id = 0;
};

}  // namespace velour
