// The views that a fit samples, and their light directions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>
#include "brdf/fit/slice_samples.h"

namespace velour {

/// Views of a fit, unit. Isotropic: on the meridian phi_v = 0, sorted by theta_v, in steps of about two degrees.
/// Otherwise an equal-area lattice over the hemisphere. None lies within kHeldOutMargin of a held-out view's polar
/// angle unless `all_data`.
std::vector<Vec3> meridian_views(bool all_data);
std::vector<Vec3> hemisphere_views(bool all_data);

/// Light directions of the view `wv` with their solid angles, as a product grid of half vectors: theta_h in quadratic
/// steps, so that the highlight is sampled as finely as MERL tabulates it, phi_h uniform, each ring rotated against the
/// previous one. d wl = 4 (wv . h) d h. Lights at or below the horizon are left out.
struct LightGrid {
  std::vector<Vec3> wl;
  std::vector<float> weight;   // sr
  std::vector<uint32_t> ring;  // index of the light's ring, which has equal theta_h
};
LightGrid light_grid(const Vec3& wv, int rings = 96, int spokes = 64);

/// Distributes the solid angle of the lights that are not `kept` to the kept ones of their ring.
void redistribute_weights(LightGrid& grid, std::span<const uint8_t> kept);

}  // namespace velour
