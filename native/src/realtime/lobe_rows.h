// A BRDF as Gaussian lobes of light directions, at many views: what a shader sums up.
#pragma once

#include "job/progress.h"
#include "material/principled_point.h"
#include "model/model.h"
#include "realtime/table_pixels.h"

namespace velour {

/// Reflected radiance is the sum over a place's lobes of colour times the light's mean over the lobe
/// (realtime/light_map.h).
///
/// Row = place of the view; a lobe is two pixels of it: centre (unit, in the view's frame) and level, then colour and
/// whether it stands for anything (1, or 0 and black).
/// Isotropic: the frame's x is along the view's azimuth, row r of n stands for the polar angle r / (n - 1) pi / 2.
/// Otherwise the frame is the surface's, and place (i, j) of a grid of n x n for the view at (-1, -1) + 2 (i, j) /
/// (n - 1) of the disk of views: its radius is the polar angle over pi / 2, and what lies outside counts as its rim.
/// Places come row by row of the grid.
struct LobeRows {
  bool isotropic = true;
  int side = 0;        // n
  bool blends = true;  // lobe i of a place is lobe i of its neighbours, so they blend; else the nearest place is meant
  int lobes = 0;       // of a place; those that are not needed are black
  TablePixels pixels = {};
};

/// What parametric models have at a view: a lobe of half vectors, or a stretched one, is Gaussians of light in a row
/// along its longer axis, each as wide as it is across, with what the change of variables does at each; what these
/// leave of f cos where they are broad is fitted by a clipped cosine and few Gaussians of fixed centres, least squares
/// over the sphere. The fit's own scattered models have such lobes; Abel-Poisson kernels count as the Gaussians of
/// their mean cosine. Symmetric models have the lobes of the light as well (realtime/exchanged_lobes.h). Throws
/// Error(invalid_argument) for the model of a BTF.
LobeRows lobe_rows(const Model& model, int threads, Progress& progress);
/// Of the material of other objects: its GGX lobe as four lobes of half vectors.
LobeRows lobe_rows(const PrincipledParameters& parameters, int threads, Progress& progress);

}  // namespace velour
