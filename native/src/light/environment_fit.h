// An equirectangular image as few weighted directions, the input of fit_environment(). Internal to light/.
#pragma once

#include <cstddef>
#include <vector>

#include "math/sphere/vec.h"

namespace velour {

class EquirectangularImage;

/// Cells of the image, fine where its energy is, as a structure of arrays in the image's frame (+z up). A cell
/// represents its texels by their exact energy-weighted mean direction; `spread` is 1 minus the length of that mean,
/// which also preserves second moments.
struct EnvironmentPoints {
  std::vector<float> x, y, z;  // unit
  std::vector<float> spread;
  std::vector<float> energy;       // luminance x solid angle, normalized to a sum of 1
  std::vector<float> solid_angle;  // sr
  std::vector<float> r, g, b;      // radiance x solid angle, with the same normalization

  size_t size() const { return x.size(); }
  Vec3 direction(size_t i) const { return {x[i], y[i], z[i]}; }
};

/// No cell has more than 1 / 4096 of the energy or is wider than three degrees, unless it is a single texel. A texel's
/// energy is spread over its bilinear footprint. The image must not be black.
EnvironmentPoints environment_points(const EquirectangularImage& image);

}  // namespace velour
