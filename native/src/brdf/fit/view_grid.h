// The views that a fit samples, and their light directions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>
#include "brdf/fit/slice_samples.h"
#include "math/sphere/frame.h"

namespace velour {

// Directions that become denser towards an axis.

/// Rings about an axis: the cap within `inner` radians, then cells of equal width on a logarithmic scale up to `outer`.
class CloseRings {
 public:
  CloseRings(const Vec3& axis, double inner, double outer, int rings, int spokes)
      : axis_(axis), frame_(Frame::about(axis)), inner_(inner), outer_(outer), rings_(rings), spokes_(spokes) {}

  size_t spokes() const { return static_cast<size_t>(spokes_); }

  /// Appends one direction per cell, ring by ring from the inside.
  void append(std::vector<Vec3>& out) const;
  /// Directions per steradian at `w`; 0 beyond the last ring.
  double density(const Vec3& w) const;

 private:
  double log_step() const;
  /// Inner radius of ring i > 0, radians.
  double edge(int i) const;

  Vec3 axis_;
  Frame frame_;
  double inner_, outer_;
  int rings_, spokes_;
};

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

/// Rings about `wv` itself, from 0.1 to 20 degrees. The grid is fine about the mirror direction and resolves
/// retro-reflection only by chance.
CloseRings retro_rings(const Vec3& wv);
/// Adds the lights of retro_rings(wv) to `grid`, made by light_grid(wv, rings, spokes), by the balance heuristic.
void join_retro_rings(LightGrid& grid, const Vec3& wv, int rings, int spokes);

/// Distributes the solid angle of the lights that are not `kept` to the kept ones of their ring.
void redistribute_weights(LightGrid& grid, std::span<const uint8_t> kept);

}  // namespace velour
