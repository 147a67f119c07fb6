// The light of a sky averaged by lobes beforehand: the product integrals of shading as look-ups.
//
// The integral of a Gaussian lobe times the sky's mixture of Gaussians is a closed form (srbf/kernel.h, [T06]) of the
// lobe's centre and bandwidth alone. So it is a function over the sphere, once for each bandwidth: an octahedral map
// [ED08] a level, finer as lobes get narrower. This is how preconvolved environments of one lobe [GKD07] become ones of
// any mixture of lobes.
#pragma once

#include "job/progress.h"
#include "realtime/table_pixels.h"
#include "scene/environment.h"
#include "scene/sky_mixture.h"

namespace velour {

/// Levels of a map. A lobe's own level is a number between two of them, so they blend.
struct LightLevels {
  static constexpr int kCosine = 0;  // averaged by the clipped cosine: irradiance / pi
  static constexpr int kBroadest =
      1;  // by a Gaussian of bandwidth 1, and of twice as much kPerOctave levels further on
  static constexpr int kPerOctave = 2;
  static constexpr int kSharpest = 27;
  static constexpr int kSky = 28;  // the sky itself, not its mixture: what stands behind a scene
  static constexpr int kCount = 29;

  /// Of a Gaussian. Bandwidths outside of 1 to 8192 count as the nearest.
  static float of(float bandwidth);
  static float bandwidth(int level);
};

/// All levels in one picture. Pixel (level, 0) of it is x, y, side, 0 of the level's map: the first pixel within its
/// border of one pixel, and its pixels along a side. A map holds radiance in its pixels' centres.
///
/// Between centres and levels look-ups are linear; they err by less than three hundredths of what a lobe sees of a
/// narrow lamp at most.
TablePixels light_map(const SkyMixture& sky, const Environment& environment, int threads, Progress& progress);

}  // namespace velour
