// A BRDF as Gaussian lobes over light directions at many views, which a shader sums up.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>
#include "base/progress.h"
#include "material/principled/principled_material.h"
#include "model/model.h"

namespace velour {

// A table for shaders: an image with four floats per pixel.

struct TablePixels {
  uint32_t width = 0, height = 0;
  std::vector<float> rgba;  // [row][column][4]

  TablePixels() = default;
  TablePixels(uint32_t w, uint32_t h) : width(w), height(h), rgba(size_t{4} * w * h) {}
  float* at(uint32_t x, uint32_t y) { return rgba.data() + 4 * (size_t{y} * width + x); }
  const float* at(uint32_t x, uint32_t y) const { return rgba.data() + 4 * (size_t{y} * width + x); }
};

/// Width in pixels of the border around a repeating table, which holds its opposite side.
inline constexpr uint32_t kTableBorder = 1;
/// The texel at pixel `pixel` of a bordered row of `size` texels.
inline uint32_t wrapped_texel(uint32_t pixel, uint32_t size) { return (pixel + size - kTableBorder) % size; }

/// Reflected radiance is the sum over a place's lobes of color times the mean of the light over the lobe
/// (realtime/light_map.h).
///
/// Each row is a place, that is, a view. Each lobe is two of its pixels: center (unit, in the view's frame) and level,
/// then color and whether it is used (1, or 0 and black).
/// Isotropic: the frame's x is along the view's azimuth, and row r of n has the polar angle r / (n - 1) pi / 2.
/// Otherwise the frame is the surface's, and place (i, j) of an n x n grid is the view at (-1, -1) + 2 (i, j) / (n - 1)
/// of the disk of views: its radius is the polar angle over pi / 2, and points outside are moved to its rim. Places are
/// in row order of the grid.
struct LobeRows {
  bool isotropic = true;
  int side = 0;        // n
  bool blends = true;  // lobe i of a place is lobe i of its neighbors, so they blend; else use the nearest place
  int lobes = 0;       // per place; unused ones are black
  TablePixels pixels = {};
};

/// Parametric models: a lobe over half vectors, or a stretched one, becomes Gaussians over light directions in a row
/// along its longer axis, each as wide as the lobe is across and scaled by the change of variables; where they are
/// broad, the residual of f cos is fitted by a clipped cosine and a few Gaussians with fixed centers, in least squares
/// over the sphere. Per-view models have Gaussian lobes already; Abel-Poisson kernels become the Gaussians of their
/// mean cosine. Symmetric models also have the lobes of the light (realtime/lobes_of_views.h). Throws
/// Error(invalid_argument) for the model of a BTF.
LobeRows lobe_rows(const Model& model, int threads, Progress& progress);
/// Rows of a Principled material: its GGX lobe becomes four lobes over half vectors.
LobeRows lobe_rows(const PrincipledParameters& parameters, int threads, Progress& progress);

}  // namespace velour
