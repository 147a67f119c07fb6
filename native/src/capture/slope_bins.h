// Overlapping bins over the slopes of facets.
#pragma once

#include <span>
#include <vector>

#include "sphere/vec.h"

namespace velour {

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

}  // namespace velour
