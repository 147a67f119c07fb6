// Bins of a virtual goniometer, and the grid of pairs that they fill.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>
#include "capture/goniometer/coated_body.h"
#include "capture/goniometer/height_field.h"
#include "math/sphere/vec.h"

namespace velour {

// Overlapping bins over pairs of directions, in which scattered rays are collected.

/// Nodes over (theta_l, phi, theta_v) and, unless isotropic, phi_v: phi = phi_l - phi_v is the azimuth between the two
/// directions, folded to [0, pi] when isotropic. With w(u) = 1 - (1 - u)^1.5, both theta and |phi| have their nodes at
/// equal steps of u: dense towards the horizon, where surfaces begin to shadow themselves, and around the forward
/// direction, into which light scatters at grazing angles. phi_v has equal steps. A bin is the hat function of its
/// node: 1 there and falling linearly to 0 at the next nodes, so that the bins of any pair add up to 1. Look-ups
/// interpolate with these hats.
class PairGrid {
 public:
  /// `phi_v_steps` cover the full turn and must be even; 0: isotropic.
  PairGrid(int theta_steps, int phi_steps, int phi_v_steps);

  size_t size() const { return size_; }

  /// The bins that `pair` falls into and its share in each.
  struct Stencil {
    int count = 0;
    std::array<uint32_t, 16> node;
    std::array<float, 16> share;
  };
  Stencil stencil(const DirectionPair& pair) const;

  /// Expected sum of shares per bin and sample, for views of uniform theta_v in [0, pi/2] and uniform azimuth and the
  /// measure cos(theta_l) d omega_l over the lights: collected flux is divided by it to obtain a BRDF. With
  /// `exchanged`, for pairs whose two directions were exchanged after sampling.
  std::vector<double> flux_measure(bool exchanged) const;

  /// Adds up bins that are equal by symmetry. Isotropic: all phi if a direction is the normal, which has no azimuth.
  /// Otherwise: the mirror images in the planes x = 0 and y = 0. `sums`: `channels` numbers per node. Ratios of pooled
  /// sums remain valid.
  void pool_by_symmetry(std::span<double> sums, int channels) const;

  /// Replaces every node by the sum over all azimuths at its two polar angles: the next coarser bins.
  void pool_azimuths(std::span<double> sums) const;

 private:
  struct Node {
    int theta_l, phi, theta_v, phi_v;
  };
  struct Axis;
  bool isotropic() const { return phi_v_steps_ == 0; }
  int phi_nodes() const { return isotropic() ? phi_steps_ + 1 : 2 * phi_steps_; }
  int phi_v_nodes() const { return isotropic() ? 1 : phi_v_steps_; }
  Node node_at(size_t index) const;
  size_t index_of(const Node& node) const;
  Axis phi_axis(const DirectionPair& pair) const;
  template <class Map>
  void add_image(std::span<double> sums, int channels, const Map& map) const;
  void pool_poles(std::span<double> sums, int channels) const;
  std::vector<double> azimuth_measure() const;

  int theta_steps_, phi_steps_, phi_v_steps_;
  size_t size_;
  std::vector<double> theta_, phi_;  // positions of the nodes; |phi| only
};

/// sums[node] += share x value for each bin of the stencil.
inline void deposit(const PairGrid::Stencil& stencil, double value, std::span<double> sums) {
  for (int i = 0; i < stencil.count; ++i) {
    const auto at = static_cast<size_t>(i);
    sums[stencil.node[at]] += static_cast<double>(stencil.share[at]) * value;
  }
}

/// Sum of share x sums[node].
inline double look_up(const PairGrid::Stencil& stencil, std::span<const double> sums) {
  double value = 0;
  for (int i = 0; i < stencil.count; ++i) {
    const auto at = static_cast<size_t>(i);
    value += static_cast<double>(stencil.share[at]) * sums[stencil.node[at]];
  }
  return value;
}

// Options of the goniometer, and the bins in which it collects light.

// Overlapping bins over the slopes of facets.

/// Nodes at (r, psi) = polar coordinates of (|slope_x| / alpha_x, |slope_y| / alpha_y): r at steps of 1 / kPerAlpha up
/// to kMaxRadius, psi at equal steps over the quarter turn that the surface's symmetry leaves; one psi when isotropic.
/// A bin is the hat function of its node; slopes beyond the last node are ignored.
class SlopeBins {
 public:
  static constexpr int kPerAlpha = 12, kMaxRadius = 6;

  SlopeBins(double alpha_x, double alpha_y);

  size_t size() const { return static_cast<size_t>(radii()) * static_cast<size_t>(psis_); }
  /// Adds one facet.
  void deposit(const Vec2& slope, std::span<double> counts) const;

  /// Facets per unit of slope_x slope_y at every node, for counts of `facets` facets in all. Bins of fewer than
  /// kEnoughFacets facets are widened along r, by up to kMaxWidening nodes on each side.
  std::vector<double> density(std::span<const double> counts, double facets) const;
  double look_up(const Vec2& slope, std::span<const double> density) const;

  static constexpr double kEnoughFacets = 400;
  static constexpr int kMaxWidening = 3;

 private:
  struct Stencil {
    size_t node[4];
    double share[4];
    bool inside;
  };
  Stencil stencil(const Vec2& slope) const;
  static constexpr int radii() { return kPerAlpha * kMaxRadius + 1; }
  double bin_area(int radius, int psi) const;
  size_t index(int radius, int psi) const { return static_cast<size_t>(radius * psis_ + psi); }

  double alpha_x_, alpha_y_;
  int psis_;
};

struct GoniometerOptions {
  HeightFieldOptions surface;
  Reflectance facets{RefractiveIndex{0.0, 1.0}};  // default: reflects everything
  Rgb base_albedo{0, 0, 0};                       // of the diffuse base
  double base_share = 0.0;                        // share of the mean plane over which the surface is base
  std::optional<CoatedBody> body;  // below a clear surface, which `facets` then describes; excludes base_share
  uint64_t seed = 0;
  int batches = 32;         // independent repetitions; errors are estimated from their spread
  int tiles_per_batch = 2;  // surfaces per batch
  uint64_t samples_per_tile = 375'000;
  int threads = 0;         // 0: all
  bool reciprocal = true;  // also counts every path with its two ends exchanged
};

/// The bins for a set of options.
struct GoniometerBins {
  explicit GoniometerBins(const GoniometerOptions& options);
  SlopeBins slopes;
  PairGrid mirror;   // one reflection, off metal or an interface
  PairGrid metal;    // several such reflections and nothing else
  PairGrid diffuse;  // light that met the base or a body; it varies slowest
};

/// Collected light. The sums of two runs may be added.
struct GoniometerSums {
  explicit GoniometerSums(const GoniometerBins& bins);
  GoniometerSums& operator+=(const GoniometerSums& other);
  GoniometerSums& operator-=(const GoniometerSums& other);

  std::vector<double> metal_facets;  // per slope bin
  double facets = 0;                 // of both kinds
  std::vector<double> tried;         // per mirror bin: sum of the guide over the mirror pairs of metal facets...
  std::vector<double> clear;         // ... and how many of them saw both the light and the viewer
  std::vector<double> metal_flux;    // per metal bin, 3 channels: flux towards wl per unit of incident flux
  std::vector<double> diffuse_flux;  // per diffuse bin, likewise
  double samples = 0;
  uint64_t rays = 0;
  uint64_t lost = 0;  // abandoned paths: lost rays, and more than kMaxBounces reflections
};

}  // namespace velour
