// Visibility of a level's texels in the views, and stand-ins for the views that hide them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "btf/fit/tensor/direction_bases.h"

namespace velour {

/// For every direction, the indices of all directions, nearest first.
std::vector<std::vector<Index>> nearest_first(const std::vector<Vec3>& directions);

/// Visibility of the relief points at the centers of a level's texels. A point hidden from a view is assumed to look as
/// from the nearest view that shows it. Views between two captured ones are interpolated, and one of the two may hide a
/// point that is visible from between them: its value there must be plausible, although no image determines it.
class ShownViews {
 public:
  /// Weight of a hidden point in a fit, relative to a visible one.
  static constexpr float kHidden = 0.002f;

  /// Keeps a reference to `source`.
  ShownViews(const TensorSource& source, size_t level, const Progress& progress);

  size_t texels() const { return texels_; }
  Index views() const { return static_cast<Index>(source_.side.view.size()); }
  /// The view whose values are used: `view` itself if it shows the texel, -1 if no view does.
  Index stand_in(size_t texel, Index view) const {
    return stand_in_[texel * source_.side.view.size() + static_cast<size_t>(view)];
  }
  bool shown(size_t texel, Index view) const { return stand_in(texel, view) == view; }
  /// Whether every view shows every texel.
  bool all() const { return all_; }

  /// Values of the texels in a view, texel x light per axis; 0 where it hides them.
  using Values = std::array<RowMatrix, 3>;
  Values values(Index view, const LevelImages& images, const Progress& progress) const;

 private:
  const TensorSource& source_;
  const Relief& relief_;
  size_t texels_;
  bool all_ = true;
  std::vector<int32_t> stand_in_;  // [texel][view]
};

}  // namespace velour
