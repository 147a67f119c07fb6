// Periodic Gaussian random surfaces, by spectral synthesis.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace velour {

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

}  // namespace velour
