// Overlapping bins over pairs of directions, in which scattered rays are collected.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "math/sphere/vec.h"

namespace velour {

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

}  // namespace velour
