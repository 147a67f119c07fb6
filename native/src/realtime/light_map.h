// Environment light prefiltered by lobes, so that the product integrals of shading become look-ups.
//
// The integral of a Gaussian lobe times the environment's mixture of Gaussians has a closed form (math/srbf/kernel.h,
// [T06]) that depends on the lobe's center and bandwidth alone. For each bandwidth it is thus a function over the
// sphere: one octahedral map [ED08] per level, finer as lobes get narrower. This generalizes environments preconvolved
// with one lobe [GKD07] to any mixture of lobes.
#pragma once

#include "base/progress.h"
#include "light/environment.h"
#include "light/environment_mixture.h"
#include "realtime/lobe_rows.h"

namespace velour {

/// Levels of a map. A lobe's level may lie between two of them, which are then blended.
struct LightLevels {
  static constexpr int kCosine = 0;    // averaged by the clipped cosine: irradiance / pi
  static constexpr int kBroadest = 1;  // by a Gaussian of bandwidth 1, which doubles every kPerOctave levels
  static constexpr int kPerOctave = 2;
  static constexpr int kSharpest = 27;
  static constexpr int kSky = 28;  // the environment itself, not its mixture: the background of a scene
  static constexpr int kCount = 29;

  /// Level of a Gaussian. Bandwidths are clamped to 1 to 8192.
  static float of(float bandwidth);
  static float bandwidth(int level);
};

/// All levels in one image. Pixel (level, 0) holds x, y, side, 0 of the level's map: its first pixel inside the border
/// of one pixel, and its number of pixels along a side. A map holds radiance at its pixel centers.
///
/// Look-ups are linear between centers and levels; their error is below three hundredths of what a lobe sees at most of
/// a narrow light.
TablePixels light_map(const EnvironmentMixture& sky, const Environment& environment, int threads, Progress& progress);

}  // namespace velour
