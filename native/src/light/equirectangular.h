// Equirectangular images of the environment: look-up, density and sampling.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>
#include "image/picture.h"
#include "light/environment.h"
#include "math/sphere/directions.h"

namespace velour {

// Run-time dispatched SIMD kernels of EquirectangularImage::sample.

/// Marginal density of the rows. Cell i of the cdf, a band, lies between the centers of rows i - 1 and i; the first and
/// the last band end at a pole.
struct MarginalTable {
  int height;
  const float* cdf;      // [height + 2]
  const int32_t* guide;  // [height + 1]
  const float* node;     // [height + 2], mean node of row i - 1; 0 at both ends
};

/// Samples in progress.
struct alignas(64) EquirectangularDraws {
  static constexpr int kCapacity = DirectionBatch::kCapacity;
  float u[kCapacity], v[kCapacity];  // random numbers in [0, 1), then the point as fractions of the image's sides
  int32_t row[kCapacity];            // row from whose density the column is sampled
  // The column's cell in that row: its index, the cdf at both ends, the density's nodes at both ends.
  float cell[kCapacity], low[kCapacity], high[kCapacity], left[kCapacity], right[kCapacity];
};

/// Samples `row` and replaces v by the point's v.
void draw_rows(const MarginalTable& table, EquirectangularDraws& draws, int count);
/// Replaces u by the point's u, sampled within the cell.
void draw_columns(int width, EquirectangularDraws& draws, int count);

// Look-up and sampling of an Environment's image. Internal to light/.
//
// Rows run from the top (theta = 0). Texel (x, y) has its center at u = (x + 1/2) / W, theta = pi (y + 1/2) / H. Every
// texel stores radiance and the density's node g = luminance sin(theta), so that one fetch reads both.

// One-dimensional densities that are linear within cells of equal width. Sampling by inversion is monotone in u, so a
// stratified u stays stratified.

/// Fills `cdf` [cells + 1], the cumulative fraction of the mass at each cell's edge, and `guide` [cells] from the
/// masses of at most 65536 cells, and returns their sum. All zero: uniform. guide[k] is the cell that contains
/// u = k / cells, so that the search in find_cell takes O(1) steps on average [CA74].
template <typename Index>
double build_cells(const std::vector<double>& mass, float* cdf, Index* guide) {
  const size_t cells = mass.size();
  double total = 0.0;
  for (double m : mass) total += m;
  double sum = 0.0;
  for (size_t i = 0; i < cells; ++i) {
    cdf[i] = static_cast<float>(total > 0.0 ? sum / total : static_cast<double>(i) / static_cast<double>(cells));
    sum += mass[i];
  }
  cdf[cells] = 1.0f;
  size_t cell = 0;
  for (size_t k = 0; k < cells; ++k) {
    const float u = static_cast<float>(k) / static_cast<float>(cells);
    while (cell + 1 < cells && cdf[cell + 1] <= u) ++cell;
    guide[k] = static_cast<Index>(cell);
  }
  return total;
}

inline size_t guide_place(float u, int cells) {
  return static_cast<size_t>(std::min(static_cast<int>(u * static_cast<float>(cells)), cells - 1));
}

/// The cell that contains `u`; `cell` is guide[guide_place(u, cells)].
inline int find_cell(const float* cdf, int cell, int cells, float u) {
  while (cell > 0 && cdf[cell] > u) --cell;  // u * cells may have been rounded up
  while (cell + 1 < cells && cdf[cell + 1] <= u) ++cell;
  return cell;
}

struct EquirectangularDraws;

struct alignas(16) EnvironmentTexel {
  float r, g, b;
  float node;  // luminance(rgb) sin(theta of the row's center)
};

class EquirectangularImage {
 public:
  explicit EquirectangularImage(const EquirectangularPixels& pixels);

  void look_up(const EnvironmentPlacement& placement, const DirectionBatch& world, RgbBatch& radiance,
               ScalarBatch& pdf) const;
  /// Samples one direction for each of `u`.
  void sample(const EnvironmentPlacement& placement, std::span<const Vec2> u, DirectionBatch& world) const;
  float mean_luminance() const { return mean_luminance_; }
  uint64_t bytes() const;
  /// Counts of invalid values among the given pixels.
  const ValueFaults& faults() const { return faults_; }

  // Read by the SIMD kernels.
  int width() const { return width_; }
  int height() const { return height_; }
  const EnvironmentTexel* row(int y) const { return &texels_[static_cast<size_t>(y) * stride_]; }
  float density_scale() const { return density_scale_; }

 private:
  void store_row(const EquirectangularPixels& pixels, int y);
  /// Builds the cells of row `y` and returns its mean node.
  double build_row(int y);
  void build_marginal(const std::vector<double>& mean);
  void find_column(EquirectangularDraws& draws, int i, int first) const;

  int width_, height_;
  size_t stride_;  // texels per stored row: W + 2, because the last and first columns are repeated at the other end
  ValueFaults faults_;
  std::vector<EnvironmentTexel> texels_;
  float mean_luminance_ = 0;
  float density_scale_ = 0;  // pdf = node * density_scale_ / sin(theta)

  // Cell j of a row lies between the centers of texels j - 1 and j (wrapped).
  std::vector<float> row_cdf_;
  std::vector<uint16_t> row_guide_;
  std::vector<float> row_node_, marginal_cdf_;  // MarginalTable
  std::vector<int32_t> marginal_guide_;
};

/// Texel coordinates of a batch of world directions: column and row cells, and the positions in them.
struct alignas(64) EquirectangularCoordinates {
  int32_t x[DirectionBatch::kCapacity], y[DirectionBatch::kCapacity];  // cell 0..W-1, 0..H
  float fx[DirectionBatch::kCapacity], fy[DirectionBatch::kCapacity];  // in [0, 1]
  float inverse_sin[DirectionBatch::kCapacity];  // of theta; falls to 0 over the half row beside a pole
};

// Run-time dispatched SIMD kernels. Angles are within 8e-7 radians: a polynomial with a relative error of 1.6e-8,
// evaluated in float32.

void equirectangular_coordinates(const EquirectangularImage& image, const Mat3& world_to_image,
                                 const DirectionBatch& world, EquirectangularCoordinates& out);
/// Bilinear radiance and density.
void equirectangular_look_up(const EquirectangularImage& image, const EnvironmentPlacement& placement,
                             const DirectionBatch& world, RgbBatch& radiance, ScalarBatch& pdf);
/// World directions of `count` points of the image, columns `u` and rows `v` from the top, as fractions of its width
/// and height. The arrays are aligned and padded to a multiple of 16.
void equirectangular_directions(const Mat3& world_to_image, const float* u, const float* v, int count,
                                DirectionBatch& world);

}  // namespace velour
