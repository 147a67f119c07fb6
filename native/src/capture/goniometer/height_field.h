// A random rough surface, and rays traced through its periodic copies.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>
#include "scene/embree_scene.h"

namespace velour {

// Periodic Gaussian random surfaces, by spectral synthesis.

/// `cells` x `cells` values, row-major, period `cells` in both directions: a Gaussian random field of mean 0, variance
/// 1 and autocorrelation exp(-r^2 / correlation^2), r and `correlation` in cells. `cells` is at least 8 correlations
/// and a correlation at least 2 cells, so that neither the period nor the sampling shows in the autocorrelation. A pure
/// function of its arguments.
std::vector<double> gaussian_field(int cells, double correlation, uint64_t seed, uint64_t stream);

struct HeightFieldOptions {
  int cells = 256;           // along each side of the tile
  double correlation = 8.0;  // cells
  double roughness = 0.2;    // Beckmann alpha along x = sqrt(2) x RMS slope of the facets
  double anisotropy = 1.0;   // alpha_x / alpha_y: cells are this much longer along y
};

/// One period of a surface of flat triangles, two per cell, split along the diagonal from (0, 0) to (1, 1). Length
/// unit: the side of a cell along x. The mean square slope of the tile's own facets, averaged over both directions in
/// units of alpha, is exactly 1 / 2, so that every surface has the stated roughness, not just the ensemble average.
struct HeightField {
  int cells = 0;
  double cell_y = 1.0;
  std::vector<float> height;

  float at(int x, int y) const {
    const auto wrap = [this](int i) { return static_cast<size_t>((i + cells) % cells); };
    return height[wrap(y) * static_cast<size_t>(cells) + wrap(x)];
  }
};

HeightField make_height_field(const HeightFieldOptions& options, uint64_t seed, uint64_t stream);

/// Marks the share of the cells where a field of correlation `correlation` is highest: patches of that size,
/// independent of any other stream. Exactly round(share x cells^2) cells are 1.
std::vector<uint8_t> make_patches(int cells, double correlation, double share, uint64_t seed, uint64_t stream);

// One period of a surface, traced as if it repeated forever.

/// A point just above the surface: rays that leave it to the upper side of its facet cannot hit the facet again.
struct FacetPoint {
  Vec3 position{0, 0, 0};
  Vec3 normal{0, 0, 1};  // of the flat facet, unit, z > 0
  bool base = false;     // diffuse base instead of metal
};

enum class Fate { hit, escaped, lost };

/// Rays that leave the tile sideways re-enter at the opposite side. Immutable after construction, thread-safe.
class PeriodicTile {
 public:
  /// `base_cells` [cells^2] marks the cells of diffuse base; empty: none.
  PeriodicTile(HeightField field, std::vector<uint8_t> base_cells);

  int facets() const { return 2 * field_.cells * field_.cells; }
  /// dz/dx and dz/dy of facet `facet`, which covers 1 / facets() of the mean plane.
  Vec2 slope(int facet) const;
  bool is_base(int facet) const { return !base_cells_.empty() && base_cells_[static_cast<size_t>(facet / 2)] != 0; }

  /// The surface above a point of the mean plane; u uniform in [0, 1)^2 makes it uniform over that plane's area.
  FacetPoint point_above(const Vec2& u) const;

  /// A point at the height of the surface's top, for rays that come down; u as in point_above().
  Vec3 place_above(const Vec2& u) const { return {u * period_, top_}; }

  /// First hit on the surface. Rays are `lost` if rounding takes them below it, or if they are so flat that they cross
  /// kMaxPeriods periods without a hit.
  Fate trace(const Vec3& origin, const Vec3& direction, FacetPoint& hit) const;
  /// True if the ray hits nothing and is not lost.
  bool escapes(const Vec3& origin, const Vec3& direction) const;

  static constexpr int kMaxPeriods = 256;

 private:
  bool enter_next_period(Ray& ray) const;
  FacetPoint surface_point(int facet, const Vec3& position) const;

  HeightField field_;
  std::vector<uint8_t> base_cells_;
  EmbreeScene scene_;
  Vec2 period_;
  float top_ = 0;   // highest point of the surface
  float lift_ = 0;  // offset of surface points along their normal, against rounding
};

}  // namespace velour
