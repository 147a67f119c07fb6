// What images say of the functions of clustered tensors when coefficients are given.
#pragma once

#include <array>

#include "compress/seen_texels.h"
#include "compress/shown_views.h"

namespace velour {

/// Of a view, sums over texels of the coefficients that are seen, times each other and times the images: all that least
/// squares over functions (TensorFunctions) need.
struct ViewMoments {
  ViewMoments(Index functions, Index lights);

  RowMatrix products;               // function x function
  std::array<RowMatrix, 3> images;  // of each axis: function x light
};

/// Views are summed over in so many groups: fixed, so that sums do not depend on threads.
inline constexpr size_t kMomentGroups = 4;

/// Adds a level, whose images are taken to be `brightness` times as bright. The same bits for any number of threads.
void add_level(const SeenTexels& seen, Index view, const LevelImages& images, const TensorTexelValues& values,
               float brightness, int threads, const Progress& progress, ViewMoments& moments);

/// Adds to the moments of all views what those views hide of a level's texels and `view` shows in their stead.
void add_hidden(const ShownViews& shown, Index view, const LevelImages& images, const TensorTexelValues& values,
                float brightness, int threads, const Progress& progress, std::vector<ViewMoments>& moments);

}  // namespace velour
