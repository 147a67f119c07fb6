// How different two pictures look: LDR-FLIP [ANA20].
#pragma once

#include <vector>
#include "math/sphere/vec.h"

namespace velour {

/// Linear Rec. 709, each channel in [0, 1]; row by row from the top.
struct LinearPicture {
  int width = 0, height = 0;
  std::vector<Rgb> pixels;
};

/// Pixels per degree of the authors' observer: 0.7 m from a display 0.7 m and 3840 pixels wide.
inline constexpr double kFlipPixelsPerDegree = 3840 * kPiD / 180;

/// FLIP of each pixel of two pictures of one size, seen with `pixels_per_degree`: 0 if they are equal, 1 at most. The
/// pictures go on beyond their borders with the color of the border. The order of the pictures matters little, but the
/// reference comes first.
std::vector<float> flip_map(const LinearPicture& reference, const LinearPicture& test,
                            double pixels_per_degree = kFlipPixelsPerDegree);

}  // namespace velour
