// One pass of expectation maximisation over the sky's cells. Internal to scene/.
#pragma once

#include "scene/sky_points.h"

namespace velour {

/// Lobes in work: energies that sum to 1 in `share`, density coefficients (share / integral of the kernel) in `peak`.
struct SkyLobes {
  std::vector<float> x, y, z, bandwidth, share, peak;
  size_t size() const { return x.size(); }
};

/// What a lobe is answerable for, by the cells' responsibilities p. Directions are relative to the lobe's centre c, so
/// that the moments of sharp lobes keep their digits: d = w - c, q = |d|^2 / 2 + spread.
struct SkyMoments {
  double energy = 0, dx = 0, dy = 0, dz = 0, q = 0;  // sums of p e, p e d, p e q
  double r = 0, g = 0, b = 0;                        // sums of p times colour
  // Where the image exceeds the mixture: the same with chi = (e - E A)^2 / (E A) in place of e, and the excess itself.
  double chi = 0, chi_x = 0, chi_y = 0, chi_z = 0, chi_q = 0, excess = 0;

  SkyMoments& operator+=(const SkyMoments& o);
};

/// Cells of one call.
inline constexpr size_t kSkyBlock = 64;

/// Adds cells [first, first + kSkyBlock) (fewer at the end) to `moments`, one entry a lobe. `scratch` holds kSkyBlock
/// floats a lobe. Run-time dispatched SIMD.
void add_sky_block(const SkyPoints& points, size_t first, const SkyLobes& lobes, float* scratch, SkyMoments* moments);

/// sum_i value_i exp(-bandwidth |w - w_i|^2 / 2) over the cells.
double smoothed_sky(const SkyPoints& points, const Vec3& w, float bandwidth);

}  // namespace velour
