// An equirectangular image as few weighted directions: what the fit of the sky's mixture reads. Internal to scene/.
#pragma once

#include <cstddef>
#include <vector>

#include "sphere/vec.h"

namespace velour {

class EquirectangularImage;

/// Cells of the image, fine where its energy is, structure of arrays. Image frame (+z up). A cell of energy e stands
/// for its texels by their exact mean direction; `spread` is 1 - the length of that mean, so second moments are kept
/// too.
struct SkyPoints {
  std::vector<float> x, y, z;  // unit
  std::vector<float> spread;
  std::vector<float> energy;       // luminance x solid angle, of the sum over all: 1 in total
  std::vector<float> solid_angle;  // sr
  std::vector<float> r, g, b;      // radiance x solid angle, in units in which the luminance's sum is 1

  size_t size() const { return x.size(); }
  Vec3 direction(size_t i) const { return {x[i], y[i], z[i]}; }
};

/// No cell holds more than 1 / 4096 of the energy or is wider than three degrees, unless it is one texel. A texel's
/// energy is spread over its bilinear footprint. The image must not be black.
SkyPoints sky_points(const EquirectangularImage& image);

}  // namespace velour
