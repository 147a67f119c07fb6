// Moments of images for fitting the functions of clustered tensors with given coefficients.
#pragma once

#include <array>

#include "compress/seen_texels.h"
#include "compress/shown_views.h"

namespace velour {

/// Sums over the texels of a view of the products of seen coefficients with each other and with the images: all that a
/// least-squares fit of functions (TensorFunctions) needs.
struct ViewMoments {
  ViewMoments(Index functions, Index lights);

  RowMatrix products;               // function x function
  std::array<RowMatrix, 3> images;  // per axis: function x light
};

/// Number of groups in which views are summed. Fixed, so that sums do not depend on threads.
inline constexpr size_t kMomentGroups = 4;

/// Adds a level with its images scaled by `brightness`. The same bits for any number of threads.
void add_level(const SeenTexels& seen, Index view, const LevelImages& images, const TensorTexelValues& values,
               float brightness, int threads, const Progress& progress, ViewMoments& moments);

/// Adds to the moments of all views the texels of a level that they hide and for which `view` stands in.
void add_hidden(const ShownViews& shown, Index view, const LevelImages& images, const TensorTexelValues& values,
                float brightness, int threads, const Progress& progress, std::vector<ViewMoments>& moments);

}  // namespace velour
