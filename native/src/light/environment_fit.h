// Fits a mixture of Gaussians to an environment by expectation maximization.
#pragma once

#include <cstddef>
#include <vector>
#include "math/sphere/vec.h"

namespace velour {

// An equirectangular image as few weighted directions, the input of fit_environment(). Internal to light/.

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
  double total = 0;                // luminance x solid angle of the whole image

  size_t size() const { return x.size(); }
  Vec3 direction(size_t i) const { return {x[i], y[i], z[i]}; }
};

/// No cell has more than 1 / 4096 of the energy or is wider than three degrees, unless it is a single texel. A texel's
/// energy is spread over its bilinear footprint. The image must not be black.
EnvironmentPoints environment_points(const EquirectangularImage& image);

// SIMD kernels for expectation maximization over the environment's cells. Internal to light/.

/// Lobes being fitted. `share`: energies, which sum to 1; `peak`: density coefficients (share / integral of the
/// kernel).
struct EnvironmentLobes {
  std::vector<float> x, y, z, bandwidth, share, peak;
  size_t size() const { return x.size(); }
};

/// Moments of the cells' energies e, weighted by the lobe's responsibilities p. Directions are relative to the lobe's
/// center c, so that the moments of sharp lobes keep their precision: d = w - c, q = |d|^2 / 2 + spread.
struct EnvironmentMoments {
  double energy = 0, dx = 0, dy = 0, dz = 0, q = 0;  // sums of p e, p e d, p e q
  double r = 0, g = 0, b = 0;                        // sums of p times color
  // Where the image exceeds the mixture, of density E over a cell's solid angle A: the same moments with
  // chi = (e - E A)^2 / (E A) in place of e, and the sum of p (e - E A).
  double chi = 0, chi_x = 0, chi_y = 0, chi_z = 0, chi_q = 0, excess = 0;

  EnvironmentMoments& operator+=(const EnvironmentMoments& o);
};

/// Maximum number of cells per call.
inline constexpr size_t kEnvironmentBlock = 64;

/// Adds cells [first, first + kEnvironmentBlock) (fewer at the end) to `moments`, one entry per lobe. `scratch` holds
/// kEnvironmentBlock floats per lobe. Run-time dispatched SIMD.
void add_environment_block(const EnvironmentPoints& points, size_t first, const EnvironmentLobes& lobes, float* scratch,
                           EnvironmentMoments* moments);

/// sum_i energy_i v_i exp(-bandwidth v_i |w - w_i|^2 / 2) over the cells, with v_i = 1 / (1 + spread_i bandwidth): the
/// kernel widened by the spread of the cell.
double smoothed_environment(const EnvironmentPoints& points, const Vec3& w, float bandwidth);

}  // namespace velour
