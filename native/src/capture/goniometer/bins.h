// Options of the goniometer, and the bins in which it collects light.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>
#include "capture/goniometer/coated_body.h"
#include "capture/goniometer/height_field.h"
#include "capture/goniometer/pair_grid.h"
#include "math/sphere/vec.h"

namespace velour {

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
