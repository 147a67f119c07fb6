// Overlapping bins over pairs of directions: where scattered rays are collected.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sphere/vec.h"

namespace velour {

/// Nodes over (theta_l, phi, theta_v) and, unless isotropic, phi_v: phi = phi_l - phi_v is the azimuth between the two
/// directions, folded to [0, pi] when isotropic. With w(u) = 1 - (1 - u)^1.5, both theta and |phi| have their nodes at
/// equal steps of u: narrow towards the horizon, where surfaces begin to hide themselves, and about the forward
/// direction, where what is scattered at grazing angles goes. phi_v has equal steps. A bin is the hat function of its
/// node: 1 there and falling linearly to 0 at the next nodes, so that the bins of any pair add up to 1. The same hats
/// interpolate.
class PairGrid {
 public:
  /// `phi_v_steps` over the full turn, even; 0: isotropic.
  PairGrid(int theta_steps, int phi_steps, int phi_v_steps);

  size_t size() const { return size_; }

  /// The bins that `pair` falls into and its share in each.
  struct Stencil {
    int count = 0;
    std::array<uint32_t, 16> node;
    std::array<float, 16> share;
  };
  Stencil stencil(const DirectionPair& pair) const;

  /// Expected sum of shares a bin, one draw a unit, for views of uniform theta_v in [0, pi/2] and uniform azimuth and
  /// the measure cos(theta_l) d omega_l over the lights: what turns collected flux into a BRDF. With `exchanged`, for
  /// pairs whose two directions were exchanged after the draw.
  std::vector<double> flux_measure(bool exchanged) const;

  /// Adds up what symmetry makes equal. Isotropic: all phi where a direction is the normal, which has no azimuth. Else:
  /// the mirror images in the planes x = 0 and y = 0. `sums`: `channels` numbers a node. Ratios of pooled sums stay
  /// ratios.
  void pool_by_symmetry(std::span<double> sums, int channels) const;

  /// Every node becomes the sum over all azimuths of its two polar angles: the next coarser bins.
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
  std::vector<double> theta_, phi_;  // of the nodes; |phi| only
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
